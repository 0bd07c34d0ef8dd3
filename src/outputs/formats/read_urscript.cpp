#include "program_points.hpp"
#include "program_text.hpp"

namespace posewright::formats {

/// movej([…]), servoj([…]), movel([…]) with joint values, and lists that movej is given by their name; p[…] is a pose.
FoundPoints read_urscript(const ProgramText& program) {
  FoundPoints points;
  const std::string text = blank_comments(program.text, "#");
  LineCounter lines(text);
  const auto moved_by_name = [&](const std::string& name) {
    for (std::size_t at = text.find("movej"); at != std::string::npos; at = text.find("movej", at + 1)) {
      Cursor cursor(text, at + 5);
      if (cursor.take('(') && cursor.word() == name) return true;
    }
    return false;
  };
  for (std::size_t open = text.find('['); open != std::string::npos; open = text.find('[', open + 1)) {
    std::size_t before = open;
    if (before > 0 && text[before - 1] == 'p' && (before < 2 || !is_word(text[before - 2]))) {
      const std::string call = before >= 2 && text[before - 2] == '(' ? name_before(text, before - 2) : "";
      if (call.starts_with("move")) points.cartesian.push_back(lines.line_at(open));
      continue;
    }
    while (before > 0 && is_blank(text[before - 1])) --before;
    std::string name;
    if (before > 0 && text[before - 1] == '(') {
      const std::string call = name_before(text, before - 1);
      if (call != "movej" && call != "movel" && call != "movep" && call != "servoj") continue;
    } else if (before > 0 && text[before - 1] == '=') {
      name = name_before(text, before);
      if (name.empty() || !moved_by_name(name)) continue;
    } else {
      continue;
    }
    Cursor cursor(text, open);
    const auto values = cursor.list('[', ']');
    if (!values) continue;
    AxisValues axes;
    for (std::size_t i = 0; i < values->size() && i < 6; ++i) axes.emplace_back(program.axes[i], (*values)[i]);
    points.by_joints.push_back({lines.line_at(open), name, axes});
  }
  return points;
}

}  // namespace posewright::formats
