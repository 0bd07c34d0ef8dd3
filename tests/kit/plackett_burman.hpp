#pragma once

#include "posewright/blocks/block_array.hpp"

namespace posewright {

inline constexpr int plackett_burman_runs = 12, plackett_burman_factors = 6;
inline constexpr int plackett_burman_main = 1 + plackett_burman_factors;
inline constexpr int plackett_burman_columns =
    plackett_burman_main + plackett_burman_factors * (plackett_burman_factors - 1) / 2;

/// Plackett & Burman (1946), 12 runs, first six columns: constant, six factors, their fifteen two-factor interactions.
inline BlockArray plackett_burman() {
  constexpr int runs = plackett_burman_runs, factors = plackett_burman_factors;
  constexpr int generator[runs - 1] = {1, 1, -1, 1, 1, 1, -1, -1, -1, 1, -1};
  BlockArray blocks(runs, 1, plackett_burman_columns);
  for (int i = 0; i < runs; ++i) {
    double* x = blocks.row(std::size_t(i), 0);
    x[0] = 1;
    for (int j = 0; j < factors; ++j) x[1 + j] = i == runs - 1 ? -1 : generator[(runs - 1 - i + j) % (runs - 1)];
    for (int j = 0, next = 1 + factors; j < factors; ++j)
      for (int k = j + 1; k < factors; ++k) x[next++] = x[1 + j] * x[1 + k];
  }
  return blocks;
}

}  // namespace posewright
