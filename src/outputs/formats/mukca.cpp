#include <fmt/format.h>

#include "formats.hpp"
#include "number_rows.hpp"
#include "posewright/outputs/format_text.hpp"
#include "program.hpp"

// Form: data/<robot>/<tool position>/hole_0.csv of MUKCa: no header, rad.

namespace posewright::formats {
namespace {

Exported write_mukca(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text;
  for (const SequencePose& pose : sequence.poses)
    for (std::size_t i = 0; i < pose.values.size(); ++i)
      text += fmt::format("{:.18e}{}", pose.values[i], i + 1 < pose.values.size() ? "," : "\n");
  return one_file("hole_0.csv", text, list_notes(sequence));
}

PoseTable read_mukca(const std::string& bytes, const std::string& file) {
  return number_table(bytes, file, ',', false);
}

}  // namespace

PoseFormat mukca() {
  return {"mukca",   "joint values, rad and m, no header", "MUKCa", ".csv", "", {}, false, false, write_mukca,
          read_mukca};
}

}  // namespace posewright::formats
