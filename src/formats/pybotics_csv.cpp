#include <fmt/format.h>

#include "formats.hpp"
#include "number_rows.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"

// Form: pybotics tests/resources/ur10-joints-poses.csv: joints in degrees, then the pose, 4 x 4 row by row, in mm.

namespace posewright::formats {
namespace {

constexpr std::size_t matrix_numbers = 16;

Exported write_pybotics_csv(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text =
      fmt::format("# {}: joints[:{}] in deg (mm), pose[-16:] predicted, in mm\n", export_mark, sequence.names.size());
  for (const SequencePose& pose : sequence.poses) {
    if (!pose.tool_pose)
      throw CannotDo(sequence.file +
                     ": pybotics-csv needs tool poses; export the plan.json itself, or to pybotics-npy");
    for (std::size_t i = 0; i < pose.values.size(); ++i)
      text += shortest(to_degrees_or_millimetres(pose.values[i], sequence.units[i])) + ",";
    const Eigen::Matrix4d X = pose.tool_pose->matrix();
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c)
        text += shortest(r < 3 && c == 3 ? X(r, c) * 1e3 : X(r, c)) + (r == 3 && c == 3 ? "\n" : ",");
  }
  std::vector<std::string> notes = list_notes(sequence);
  notes.push_back("the tool poses are predictions (nominal model, measurement frame): replace them by measured values");
  return one_file("calposes.csv", text, notes);
}

PoseTable read_pybotics_csv(const std::string& bytes, const std::string& file) {
  PoseTable table;
  for (const NumberRow& numbers : read_number_rows(bytes, file, ',', false)) {
    if (numbers.values.size() <= matrix_numbers)
      throw InputError({file, numbers.line}, fmt::format("has {} numbers", numbers.values.size()),
                       "joints, then the 16 numbers of a pose");
    PoseRow row;
    row.line = numbers.line;
    row.cells.assign(numbers.values.begin(), numbers.values.end() - matrix_numbers);
    table.rows.push_back(std::move(row));
  }
  table.units.assign(table.rows.front().cells.size(), degrees_or_millimetres);
  return table;
}

}  // namespace

PoseFormat pybotics_csv() {
  PoseFormat format = {"pybotics-csv",
                       "joint values and tool poses, deg and mm",
                       "pybotics",
                       ".csv",
                       "tool poses",
                       {},
                       false,
                       false,
                       write_pybotics_csv,
                       read_pybotics_csv};
  format.to_be_filled = true;
  return format;
}

}  // namespace posewright::formats
