#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Limits of the frames among the columns that no tolerance holds: a metre and a radian (1σ). Tool, targets, camera and
/// board lie about where the file puts them; base, stations and anchors, which may stand anywhere, about where `placed`
/// puts them, and have no limit without it.
/// @param placed  corrections of all parameters after the placing fit; empty: not placed yet
std::vector<WeakLimit> frame_limits(const IdentificationModel& model, const VariantColumns& columns, Prior prior,
                                    const std::vector<double>& placed = {});

/// The direction in which readings and tolerances, without the weak limits, tell least of where frames are.
struct LooseDirection {
  std::string unit;           ///< "m": displaced; "rad": turned
  double sigma = 0.0;         ///< along it, `unit`
  Eigen::VectorXd direction;  ///< of length one, over the free columns of this unit; the largest entry is positive
  std::vector<std::string> columns{};
  std::string text() const;  ///< "0.71 base.z + 0.7 target.P.z"
};

/// The direction of frames without a tolerance whose σ is the most times what is allowed; none: all are within.
/// @param size  of the robot, m: beyond it a displacement is not known; a rotation beyond a radian
std::optional<LooseDirection> loose_direction(const VariantColumns& columns, Prior prior, const Fit& result,
                                              double size);

/// Farthest distance of the tip from the middle of all that random configurations within the limits reach, m; at least
/// the metre of the weak limits.
double size_of(const IdentificationModel& model);

}  // namespace posewright
