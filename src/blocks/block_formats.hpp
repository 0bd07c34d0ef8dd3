#pragma once

#include <optional>
#include <string_view>

#include "posewright/blocks/read_blocks.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

bool is_npy(std::string_view bytes);
/// Without holding the file in memory; fills in its hash.
BlockFile read_npy(const std::filesystem::path& file, std::optional<int> rows);
BlockShare read_npy_share(const std::filesystem::path& file, std::optional<int> rows, int rank, int processes,
                          std::size_t spare);
BlockFile parse_csv(std::string_view bytes, std::optional<int> rows, const SourcePlace& place);

/// n from the number of table rows; throws if `rows` does not divide it or n or m is zero.
std::size_t count_blocks(std::size_t table_rows, std::optional<int> rows, const SourcePlace& place);

}  // namespace posewright
