#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Orientation of a frame with three estimated angles rx, ry, rz. Intervals of angles about axes that turn
/// with each other mean little once the frame is turned far, and the angles have two branches: σ and intervals are
/// those of a small rotation of the estimate about the axes of the frame's parent.
struct CalibratedOrientation {
  std::string frame;           ///< "base", "station.A"
  Eigen::Vector3d angles;      ///< rx, ry, rz of the estimate, rad: R = Rz Ry Rx
  Eigen::Matrix3d covariance;  ///< of the rotation vector, rad²
  Eigen::Vector3d half_width;  ///< of its intervals, rad
};

/// For every placed frame (Parameter::places) with its three angles among the columns.
/// @param stretch  half the width of an interval in σ, see interval_factor()
std::vector<CalibratedOrientation> orientations(const IdentificationModel& model, const VariantColumns& columns,
                                                const Fit& result, double stretch);

}  // namespace posewright
