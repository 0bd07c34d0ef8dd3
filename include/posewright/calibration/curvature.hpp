#pragma once

#include <string>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// How far the problem is from linear within the confidence region (after Bates & Watts 1980, J. R. Stat. Soc. B 42).
struct Curvature {
  double largest = 0.0;  ///< ‖f(x + v) − 2f(x) + f(x − v)‖ / 2 / ‖Jv‖ over the principal axes v of the region: share of
                         ///< the step of one σ that the linear model misses; infinite if the axis leaves the reach
  int parameter = -1;  ///< column that moves most along that axis, in units of its σ
};

/// Above this at one σ, intervals of two σ can be wrong by as much as they are long.
inline constexpr double curvature_limit = 0.15;

/// @param result  of these poses and columns
Curvature curvature(const IdentificationModel& model, const VariantColumns& columns,
                    const std::vector<MeasuredPose>& poses, const Fit& result);

}  // namespace posewright
