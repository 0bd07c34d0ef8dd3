#include <fmt/format.h>

#include <algorithm>

#include "formats.hpp"
#include "number_rows.hpp"
#include "posewright/formats/format_text.hpp"
#include "program.hpp"

// No public text gives RoboDK's rule for columns: a header and one row a pose, in degrees, is a guess.

namespace posewright::formats {
namespace {

/// J1, J2, …; "[mm]" behind those that slide, which are external axes, E1, E2, …, of an arm with six that turn.
std::string header(const std::vector<std::string>& units) {
  const bool arm = std::ranges::count(units, "rad") == 6;
  std::string text;
  int joint = 0, external = 0;
  for (const std::string& unit : units) {
    const bool slides = unit != "rad";
    text += fmt::format("{}{}{}{}", text.empty() ? "" : ",", slides && arm ? "E" : "J",
                        slides && arm ? ++external : ++joint, slides ? " [mm]" : "");
  }
  return text + "\n";
}

Exported write_robodk_csv(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text = header(sequence.units);
  for (const SequencePose& pose : sequence.poses)
    for (std::size_t i = 0; i < pose.values.size(); ++i)
      text += shortest(to_degrees_or_millimetres(pose.values[i], sequence.units[i])) +
              (i + 1 < pose.values.size() ? "," : "\n");
  std::vector<std::string> notes = list_notes(sequence);
  notes.push_back("how RoboDK wants columns is not documented: one row a pose, J1 ... in deg, is a guess");
  return one_file("joints.csv", text, notes);
}

PoseTable read_robodk_csv(const std::string& bytes, const std::string& file) {
  PoseTable table;
  for (const NumberRow& numbers : read_number_rows(bytes, file, ',', true))
    table.rows.push_back({numbers.line, {numbers.values.begin(), numbers.values.end()}});
  table.units.assign(table.rows.front().cells.size(), degrees_or_millimetres);
  return table;
}

}  // namespace

PoseFormat robodk_csv() {
  return {.name = "robodk-csv",
          .description = "joint values, deg (columns are a guess)",
          .used_by = "RoboDK",
          .extension = ".csv",
          .write = write_robodk_csv,
          .read = read_robodk_csv};
}

}  // namespace posewright::formats
