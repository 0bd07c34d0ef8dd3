#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "formats.hpp"
#include "posewright/blocks/read_blocks.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"

// pybotics takes joints as an array n x joints in rad. NumPy format version 1.0.

namespace posewright::formats {
namespace {

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

PoseFormat pybotics_npy() {
  return {"pybotics-npy",
          "array of joint values, rad and m",
          "pybotics, NumPy",
          ".npy",
          "",
          {},
          false,
          false,
          write_pybotics_npy,
          read_pybotics_npy};
}

}  // namespace posewright::formats
