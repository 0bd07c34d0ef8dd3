#include <algorithm>
#include <string_view>

#include "program_points.hpp"
#include "program_text.hpp"

namespace posewright::formats {

/// <Value key="0" j1="0" … j6="0"/>; x="…" y="…" is a position.
FoundPoints read_val3(const ProgramText& program) {
  FoundPoints points;
  LineCounter lines(program.text);
  std::string data;
  for (std::size_t at = program.text.find('<'); at != std::string::npos; at = program.text.find('<', at + 1)) {
    const std::size_t end = std::min(program.text.find('>', at), program.text.size());
    const std::string_view tag = std::string_view(program.text).substr(at, end - at);
    if (tag.starts_with("<Data")) {
      const std::size_t name = tag.find("name=\"");
      data =
          name == std::string_view::npos ? "" : std::string(tag.substr(name + 6, tag.find('"', name + 6) - name - 6));
    }
    if (!tag.starts_with("<Value")) continue;
    AxisValues axes;
    bool position = false;
    for (std::size_t i = 0; i < tag.size(); ++i) {
      if (tag[i] != '=' || i + 1 >= tag.size() || tag[i + 1] != '"') continue;
      const std::string name = name_before(tag, i);
      Cursor cursor(program.text, at + i + 2);
      const auto value = cursor.number();
      if (value && name.size() == 2 && name[0] == 'j') axes.emplace_back(name, *value);
      position = position || (value && name == "x");
    }
    const int line = lines.line_at(at);
    if (!axes.empty()) points.by_joints.push_back({line, data, axes});
    else if (position) points.cartesian.push_back(line);
  }
  return points;
}

}  // namespace posewright::formats
