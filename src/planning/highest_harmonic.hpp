#pragma once

#include <span>

namespace posewright {

/// Of a function at 2D + 1 equispaced angles of one axis: the highest harmonic whose amplitude is more than `nothing`,
/// or is no number; 0: none.
int highest_harmonic(std::span<const double> values, double nothing);

}  // namespace posewright
