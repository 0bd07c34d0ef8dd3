#pragma once

#include <limits>

namespace posewright {

/// Relative distance of neighbouring doubles.
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// n over k.
inline double binomial(int n, int k) {
  double result = 1;
  for (int i = 0; i < k; ++i) result = result * (n - i) / (i + 1);
  return result;
}

}  // namespace posewright
