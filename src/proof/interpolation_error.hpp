#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "posewright/proof/harmonic_function.hpp"

namespace posewright {

/// More than a function is off by that was interpolated: 100 times the largest difference to what was computed at
/// random places, and what rounding makes of the values themselves. None: it is not the same function.
/// @param places  values of the axes
/// @param values  computed there
inline std::optional<double> interpolation_error(const HarmonicFunction& f,
                                                 const std::vector<std::vector<double>>& places,
                                                 const std::vector<double>& values) {
  // It may differ by this share of its size.
  constexpr double same_function = 1e-7, difference_factor = 100.0, own_rounding = 1e-10;
  double difference = 0, size = 0;
  for (const double value : values) size = std::max(size, std::abs(value));
  for (std::size_t i = 0; i < values.size(); ++i)
    difference = std::max(difference, std::abs(f.value(places[i]) - values[i]));
  if (!f.defined() || !(difference <= same_function * size)) return std::nullopt;
  return difference_factor * difference + own_rounding * size;
}

}  // namespace posewright
