#include "posewright/blocks/block_array.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>

namespace posewright {

BlockArray::BlockArray(std::size_t count, int rows, int columns)
    : count_(count), rows_(rows), columns_(columns), stride_((columns + 7) / 8 * 8) {
  // In 64 bits: where std::size_t has 32, the product would wrap, and the array be smaller than its blocks.
  const std::uint64_t wanted = std::uint64_t(count_) * std::uint64_t(rows_) * std::uint64_t(stride_);
  if (wanted > std::numeric_limits<std::size_t>::max() / sizeof(double)) throw std::bad_alloc();
  const std::size_t doubles = std::max<std::size_t>(8, std::size_t(wanted));
  data_.reset(static_cast<double*>(std::aligned_alloc(64, doubles * sizeof(double))));
  if (!data_) throw std::bad_alloc();
  std::fill_n(data_.get(), doubles, 0.0);
}

BlockArray BlockArray::subset(const std::vector<int>& blocks) const {
  BlockArray copy(blocks.size(), rows_, columns_);
  const std::size_t length = std::size_t(rows_) * std::size_t(stride_);
  for (std::size_t i = 0; i < blocks.size(); ++i) std::copy_n(row(std::size_t(blocks[i]), 0), length, copy.row(i, 0));
  return copy;
}

}  // namespace posewright
