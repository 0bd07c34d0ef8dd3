#include "posewright/blocks/read_blocks.hpp"

#include <cmath>

#include "block_formats.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright {

BlockFile read_blocks(const std::filesystem::path& file, std::optional<int> rows) {
  const std::string bytes = read_file(file);
  const SourcePlace place{file.string(), 0};
  if (bytes.empty()) throw InputError(place, "is empty", "a .npy array or a CSV table is needed");
  if (rows && *rows < 1) throw InputError({}, "--rows " + std::to_string(*rows), "must be at least 1");
  BlockFile result = is_npy(bytes) ? parse_npy(bytes, rows, place) : parse_csv(bytes, rows, place);
  if (result.columns.empty())
    for (int j = 0; j < result.blocks.columns(); ++j) result.columns.push_back("column " + std::to_string(j));
  result.sha256 = sha256_hex(bytes);
  return result;
}

}  // namespace posewright
