#include <algorithm>

#include "program_points.hpp"
#include "program_text.hpp"

namespace posewright::formats {

/// P[1]{ GP1: UF : 0, UT : 1, J1= 0.0 deg, … }; X = … is a position.
FoundPoints read_tp(const ProgramText& program) {
  FoundPoints points;
  LineCounter lines(program.text);
  const std::size_t section = program.text.find("/POS");
  for (std::size_t at = section == std::string::npos ? program.text.size() : section;
       (at = program.text.find("P[", at)) != std::string::npos;) {
    const std::size_t open = program.text.find('{', at), close = program.text.find('}', at);
    if (open == std::string::npos || close == std::string::npos || close < open) break;
    const std::string name = program.text.substr(at, std::min(open - at, std::size_t(40)));
    AxisValues axes;
    bool position = false;
    for (std::size_t i = open; i < close; ++i) {
      if (program.text[i] != '=') continue;
      const std::string axis = name_before(program.text, i);
      Cursor cursor(program.text, i + 1);
      const auto value = cursor.number();
      if (value) axes.emplace_back(axis, *value);
      position = position || upper(axis) == "X";
    }
    const int line = lines.line_at(at);
    if (position) points.cartesian.push_back(line);
    else if (!axes.empty()) points.by_joints.push_back({line, name.substr(0, name.find_last_of(']') + 1), axes});
    at = close;
  }
  return points;
}

}  // namespace posewright::formats
