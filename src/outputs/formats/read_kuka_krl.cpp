#include <algorithm>
#include <string_view>

#include "program_points.hpp"
#include "program_text.hpp"

namespace posewright::formats {

/// {A1 0.0,A2 -90.0,…}, with or without external axes; {X …} is a position.
FoundPoints read_krl(const ProgramText& program) {
  FoundPoints points;
  for_each_line(program.text, [&](int line, std::size_t begin, std::string_view all) {
    const std::string_view text = without_comment(all, ";");
    for (std::size_t open = text.find('{'); open != std::string_view::npos; open = text.find('{', open + 1)) {
      Cursor cursor(text, open + 1);
      AxisValues axes;
      do {
        const std::string name = cursor.word();
        if (cursor.take(':')) axes.clear();  // {E6AXIS: A1 …}
        else if (const auto value = cursor.number())
          axes.emplace_back(name, TextNumber{begin + value->begin, begin + value->end, value->value});
        else break;
      } while (cursor.take(',') || axes.empty());
      const auto has = [&](const char* name) {
        return std::any_of(axes.begin(), axes.end(), [&](const auto& a) { return upper(a.first) == name; });
      };
      const std::string before = upper(text.substr(0, open));
      if (has("A1")) points.by_joints.push_back({line, name_before(text, open), axes});
      else if (has("X") && before.find("FRAME") == std::string::npos && before.find("$TOOL") == std::string::npos &&
               before.find("$BASE") == std::string::npos)
        points.cartesian.push_back(line);
    }
  });
  return points;
}

}  // namespace posewright::formats
