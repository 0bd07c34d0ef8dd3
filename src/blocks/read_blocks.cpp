#include "posewright/blocks/read_blocks.hpp"

#include <cmath>

#include "block_formats.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright {

namespace {

bool is_npy_file(const std::filesystem::path& file, std::optional<int> rows) {
  std::string first(8, '\0');
  first.resize(FileReader(file).read(first.data(), first.size()));
  if (first.empty()) throw InputError({file.string(), 0}, "is empty", "a .npy array or a CSV table is needed");
  if (rows && *rows < 1) throw InputError({}, "--rows " + std::to_string(*rows), "must be at least 1");
  return is_npy(first);
}

}  // namespace

BlockFile read_blocks(const std::filesystem::path& file, std::optional<int> rows) {
  const SourcePlace place{file.string(), 0};
  BlockFile result;
  if (is_npy_file(file, rows)) {
    result = read_npy(file, rows);
  } else {
    const std::string bytes = read_file(file);
    result = parse_csv(bytes, rows, place);
    result.sha256 = sha256_hex(bytes);
  }
  if (result.columns.empty())
    for (int j = 0; j < result.blocks.columns(); ++j) result.columns.push_back("column " + std::to_string(j));
  return result;
}

BlockShare read_block_share(const std::filesystem::path& file, std::optional<int> rows, int rank, int processes,
                            std::size_t spare) {
  if (!is_npy_file(file, rows))
    throw InputError({file.string(), 0}, "is a table of text, which cannot be spread over processes",
                     "save the array with numpy.save");
  return read_npy_share(file, rows, rank, processes, spare);
}

}  // namespace posewright
