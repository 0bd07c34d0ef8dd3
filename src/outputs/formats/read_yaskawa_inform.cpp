#include <string_view>

#include "posewright/support/trimmed.hpp"
#include "program_points.hpp"
#include "program_text.hpp"

namespace posewright::formats {

/// C00000=0,0,0,0,30720,0 of ///POSTYPE PULSE; other kinds are positions.
FoundPoints read_inform(const ProgramText& program) {
  FoundPoints points;
  bool pulses = false;
  for_each_line(program.text, [&](int line, std::size_t begin, std::string_view text) {
    const std::string_view plain = trimmed(text);
    if (plain.starts_with("///POSTYPE")) pulses = plain.find("PULSE") != std::string_view::npos;
    if (plain.size() < 2 || plain.front() != 'C' || !is_digit(plain[1])) return;
    const std::size_t equal = text.find('=');
    if (equal == std::string_view::npos) return;
    if (!pulses) {
      points.cartesian.push_back(line);
      return;
    }
    Cursor cursor(text, equal + 1);
    AxisValues axes;
    do {
      const auto value = cursor.number();
      if (!value || axes.size() == 6) break;
      axes.emplace_back(program.axes[axes.size()], TextNumber{begin + value->begin, begin + value->end, value->value});
    } while (cursor.take(','));
    points.by_joints.push_back({line, std::string(trimmed(text.substr(0, equal))), axes});
  });
  return points;
}

}  // namespace posewright::formats
