#include "program_points.hpp"
#include "program_text.hpp"

namespace posewright::formats {

/// [[six numbers],[six numbers]] is a jointtarget, [[3],[4],[4],[6]] a robtarget.
FoundPoints read_rapid(const ProgramText& program) {
  FoundPoints points;
  const std::string text = blank_comments(program.text, "!");
  LineCounter lines(text);
  for (std::size_t open = text.find('['); open != std::string::npos; open = text.find('[', open + 1)) {
    Cursor cursor(text, open + 1);
    const auto first = cursor.list('[', ']');
    if (!first || !cursor.take(',')) continue;
    const auto second = cursor.list('[', ']');
    if (!second) continue;
    if (first->size() == 6 && second->size() == 6 && cursor.take(']')) {
      AxisValues axes;
      for (std::size_t i = 0; i < 6; ++i) axes.emplace_back(program.axes[i], (*first)[i]);
      for (std::size_t i = 0; i < 6; ++i)
        if ((*second)[i].value < 8.9e9) axes.emplace_back(program.axes[6 + i], (*second)[i]);
      points.by_joints.push_back({lines.line_at(open), name_before(text, open), axes});
      open = cursor.at - 1;
    } else if (first->size() == 3 && second->size() == 4 && cursor.take(',') && cursor.list('[', ']') &&
               cursor.take(',') && cursor.list('[', ']')) {
      points.cartesian.push_back(lines.line_at(open));
      open = cursor.at - 1;
    }
  }
  return points;
}

}  // namespace posewright::formats
