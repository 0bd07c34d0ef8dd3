#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "formats.hpp"
#include "number_rows.hpp"
#include "posewright/blocks/read_blocks.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"

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

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

Exported write_pybotics_npy(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}",
                                   sequence.poses.size(), sequence.names.size());
  // Magic, version and length take 10 bytes; the data begins at a multiple of 64.
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += char(header.size() & 0xFF);
  bytes += char(header.size() >> 8);
  bytes += header;
  for (const SequencePose& pose : sequence.poses)
    for (const double value : pose.values) {
      char raw[sizeof value];
      std::memcpy(raw, &value, sizeof value);
      bytes.append(raw, sizeof value);
    }
  return one_file("calposes.npy", bytes, list_notes(sequence));
}

PoseTable read_pybotics_npy(const std::string& bytes, const std::string& file) {
  const BlockArray array = parse_npy(bytes, 1, {file, 0});
  PoseTable table;
  for (std::size_t i = 0; i < array.count(); ++i) {
    PoseRow row;
    const double* values = array.row(i, 0);
    for (int j = 0; j < array.columns(); ++j) row.cells.emplace_back(values[j] == 0 ? 0.0 : values[j]);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

PoseFormat pybotics_csv() {
  return {.name = "pybotics-csv",
          .description = "joint values and tool poses, deg and mm",
          .used_by = "pybotics",
          .extension = ".csv",
          .needs = "tool poses",
          .write = write_pybotics_csv,
          .read = read_pybotics_csv,
          .to_be_filled = true};
}

PoseFormat pybotics_npy() {
  return {.name = "pybotics-npy",
          .description = "array of joint values, rad and m",
          .used_by = "pybotics, NumPy",
          .extension = ".npy",
          .write = write_pybotics_npy,
          .read = read_pybotics_npy};
}

}  // namespace posewright::formats
