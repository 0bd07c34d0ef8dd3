#pragma once

#include <cmath>
#include <numbers>

#include "posewright/blocks/block_array.hpp"
#include "posewright/support/random.hpp"

namespace posewright {

/// Blocks of independent standard normal entries (Box–Muller on the project's own generator).
inline BlockArray random_blocks(std::size_t count, int rows, int columns, std::uint64_t seed) {
  BlockArray blocks(count, rows, columns);
  Random random(seed, 0);
  for (std::size_t i = 0; i < count; ++i)
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c)
        blocks.row(i, r)[c] =
            std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * std::numbers::pi * random.uniform());
  return blocks;
}

}  // namespace posewright
