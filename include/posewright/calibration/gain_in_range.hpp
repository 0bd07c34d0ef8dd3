#pragma once

#include <optional>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// At most a hundred configurations that can be measured, each coordinate between its values at two of `poses`.
std::vector<MeasuredPose> poses_between(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                        const std::vector<double>& placed);

/// Gain of an estimate x̂ over x₀, base and tool alone, at configurations drawn within the limits of the coordinates, in
/// its standard deviations. With whitened rows J of the lengths there (of all readings if there are none), A = JᵀJ,
/// δ = x̂ − x₀ and the true x normal about x̂ with its covariance C,
///
///   ‖J(x − x₀)‖² − ‖J(x − x̂)‖² = δᵀAδ + 2 δᵀA(x − x̂),   z = δᵀAδ / (2 √(δᵀA C A δ)).
///
/// Poses of a small region may show a gain between them and none beyond. Empty if no configuration can be measured, or
/// x̂ = x₀.
/// @param placed  corrections of all parameters, x₀
std::optional<double> gain_in_range(const IdentificationModel& model, const VariantColumns& columns,
                                    const std::vector<MeasuredPose>& poses, const std::vector<double>& placed,
                                    const Fit& fit);

}  // namespace posewright
