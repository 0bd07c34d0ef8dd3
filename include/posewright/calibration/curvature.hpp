#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Nonlinearity of the problem within the confidence region (after Bates & Watts 1980, J. R. Stat. Soc. B 42).
struct Curvature {
  double largest = 0.0;  ///< ‖f(x + v) − 2f(x) + f(x − v)‖ / 2 / ‖Jv‖ over the principal axes v of the region: share of
                         ///< the step of one σ that the linear model misses; infinite if the axis leaves the reach
  int parameter = -1;  ///< column that moves most along that axis, in units of its σ
  /// The part of it that no other parameters make good, because it is at right angles to all that they do: what bends
  /// the surface of all predictions itself. Largest over the axes; as `largest` if an axis leaves the reach.
  double intrinsic = 0.0;
  /// Columns whose linear intervals are rough, ascending: those that move with an axis along which more than
  /// curvature_limit is missed (a tenth of their variance lies along it), or that the second order moves by more than
  /// that share of their σ.
  std::vector<int> bent;
};

/// Above this at one σ, intervals of two σ can be wrong by as much as they are long.
inline constexpr double curvature_limit = 0.15;

/// @param result  of these poses and columns
Curvature curvature(const IdentificationModel& model, const VariantColumns& columns,
                    const std::vector<MeasuredPose>& poses, const Fit& result);

}  // namespace posewright
