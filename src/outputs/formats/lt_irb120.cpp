#include <fmt/format.h>

#include "formats.hpp"
#include "number_rows.hpp"
#include "posewright/outputs/format_text.hpp"
#include "program.hpp"

// Form: generated_joints.txt of LT-IRB120, as numpy.savetxt writes it: degrees.

namespace posewright::formats {
namespace {

Exported write_lt_irb120(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text;
  for (const SequencePose& pose : sequence.poses)
    for (std::size_t i = 0; i < pose.values.size(); ++i)
      text += fmt::format("{:.18e}{}", to_degrees_or_millimetres(pose.values[i], sequence.units[i]),
                          i + 1 < pose.values.size() ? " " : "\n");
  return one_file("generated_joints.txt", text, list_notes(sequence));
}

PoseTable read_lt_irb120(const std::string& bytes, const std::string& file) {
  return number_table(bytes, file, ' ', false, degrees_or_millimetres);
}

}  // namespace

PoseFormat lt_irb120() {
  return {"lt-irb120",
          "joint values, deg, between blanks",
          "LT-IRB120, numpy.loadtxt",
          ".txt",
          "",
          {},
          false,
          false,
          write_lt_irb120,
          read_lt_irb120};
}

}  // namespace posewright::formats
