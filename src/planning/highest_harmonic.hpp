#pragma once

#include <span>

namespace posewright {

/// Highest harmonic of a function at 2D + 1 equispaced angles of one axis, with an amplitude above `nothing`
/// or NaN; 0: none.
int highest_harmonic(std::span<const double> values, double nothing);

}  // namespace posewright
