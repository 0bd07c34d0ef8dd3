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
/// Throws InputError (file:line, error, allowed values) on anything malformed, NaN or infinite.
BlockFile read_blocks(const std::filesystem::path& file, std::optional<int> rows);

/// Blocks of a file that one of several processes holds.
struct BlockShare {
  /// Its candidates, then `spare` blocks of zeros.
  BlockArray blocks;
  std::size_t first = 0, count = 0, total = 0;  ///< the first candidate, how many, and how many the file has
  std::string sha256;                           ///< of the file's bytes; process 0 alone reads all of them
};

/// Candidates are dealt out in groups of so many, neighbours to one process.
inline constexpr std::size_t share_group = 64;

/// The first candidate of process `rank`; of the one behind the last: their number.
std::size_t first_of_share(std::size_t total, int rank, int processes);

/// Reads the share of one of several processes without holding more. Throws InputError as read_blocks() does, of
/// numbers that are not finite where they are in the share, and for a table of text, whose rows no process can find
/// without reading all of it.
BlockShare read_block_share(const std::filesystem::path& file, std::optional<int> rows, int rank, int processes,
                            std::size_t spare);

/// Overload for a .npy in memory.
BlockArray parse_npy(std::string_view bytes, std::optional<int> rows, const SourcePlace& place);

}  // namespace posewright
