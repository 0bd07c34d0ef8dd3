#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

/// Jacobian blocks that a user brings.
struct BlockFile {
  BlockArray blocks;
  std::vector<std::string> columns;  ///< from the CSV header; "column 0", … if there is none
  std::string sha256;                ///< of the file's bytes
};

/// Reads whitened Jacobian blocks: NumPy .npy (float64 or float32, little endian, C order, shape n × r × m, or
/// (n·r) × m together with `rows`) or CSV (n·r rows × m columns, optional header line, '#' comments).
/// Which of the two it is, the file's first bytes tell.
/// @param rows  r; required for CSV and two-dimensional .npy, otherwise it must agree with the file
/// Throws InputError (file:line, what, what is allowed) on anything malformed, NaN or infinite.
BlockFile read_blocks(const std::filesystem::path& file, std::optional<int> rows);

/// The same of a .npy that is in memory already.
BlockArray parse_npy(std::string_view bytes, std::optional<int> rows, const SourcePlace& place);

}  // namespace posewright
