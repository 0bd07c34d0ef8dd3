#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "posewright/support/error.hpp"
#include "posewright/support/trimmed.hpp"
#include "program_points.hpp"
#include "program_text.hpp"

namespace posewright::formats {

/// positions: [ … ] of trajectory_msgs/JointTrajectory, in the order of joint_names.
FoundPoints read_trajectory(const ProgramText& program) {
  FoundPoints points;
  const std::string text = blank_comments(program.text, "#");
  LineCounter lines(text);
  constexpr std::string_view head = "joint_names:", key = "positions:";
  const std::size_t named = text.find(head);
  if (named == std::string::npos)
    throw InputError({program.file, 0}, "has no joint_names", "trajectory_msgs/JointTrajectory");
  Cursor cursor(text, named + head.size());
  std::vector<std::string> names;
  if (cursor.take('[')) {
    do {
      cursor.skip_blanks();
      std::string name;
      while (!cursor.done() && cursor.now() != ',' && cursor.now() != ']') name += text[cursor.at++];
      std::erase_if(name, [](char c) { return c == '"' || c == '\''; });
      names.emplace_back(trimmed(name));
    } while (cursor.take(','));
  } else {
    while (cursor.take('-')) {
      const std::size_t end = std::min(text.find('\n', cursor.at), text.size());
      std::string name(trimmed(std::string_view(text).substr(cursor.at, end - cursor.at)));
      std::erase_if(name, [](char c) { return c == '"' || c == '\''; });
      names.push_back(name);
      cursor.at = end;
    }
  }
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
    cursor.at = at + key.size();
    const auto values = cursor.list('[', ']');
    const int line = lines.line_at(at);
    if (!values || values->size() != names.size())
      throw InputError({program.file, line}, "has positions that are no list in brackets of one number a joint",
                       fmt::format("positions: [{} numbers]", names.size()));
    AxisValues axes;
    for (std::size_t i = 0; i < names.size(); ++i) axes.emplace_back(names[i], (*values)[i]);
    points.by_joints.push_back({line, "", axes});
  }
  return points;
}

}  // namespace posewright::formats
