#include <fmt/format.h>

#include "formats.hpp"
#include "number_rows.hpp"
#include "posewright/outputs/format_text.hpp"
#include "program.hpp"

// No public text gives RoboDK's rule for columns: a header and one row a pose, in degrees, is a guess.

namespace posewright::formats {
namespace {

Exported write_robodk_csv(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text;
  for (std::size_t i = 0; i < sequence.names.size(); ++i) text += fmt::format("{}J{}", i > 0 ? "," : "", i + 1);
  text += "\n";
  for (const SequencePose& pose : sequence.poses)
    for (std::size_t i = 0; i < pose.values.size(); ++i)
      text += shortest(to_degrees_or_millimetres(pose.values[i], sequence.units[i])) +
              (i + 1 < pose.values.size() ? "," : "\n");
  std::vector<std::string> notes = list_notes(sequence);
  notes.push_back("how RoboDK wants columns is not documented: one row a pose, J1 ... in deg, is a guess");
  return one_file("joints.csv", text, notes);
}

PoseTable read_robodk_csv(const std::string& bytes, const std::string& file) {
  return number_table(bytes, file, ',', true, degrees_or_millimetres);
}

}  // namespace

PoseFormat robodk_csv() {
  return {"robodk-csv",
          "joint values, deg (columns are a guess)",
          "RoboDK",
          ".csv",
          "",
          {},
          false,
          false,
          write_robodk_csv,
          read_robodk_csv};
}

}  // namespace posewright::formats
