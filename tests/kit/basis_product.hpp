#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "posewright/proof/harmonic_function.hpp"

namespace posewright {

/// Product i of 1, cos, sin of every angle and 1, x of every number.
inline double basis_product(const std::vector<HarmonicAxis>& axes, std::size_t i, std::span<const double> q) {
  double product = 1;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const std::size_t terms = axes[a].turns ? 3 : 2, k = i % terms;
    i /= terms;
    product *= k == 0 ? 1 : !axes[a].turns ? q[a] : k == 1 ? std::cos(q[a]) : std::sin(q[a]);
  }
  return product;
}

}  // namespace posewright
