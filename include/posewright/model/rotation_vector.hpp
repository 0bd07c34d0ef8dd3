#pragma once

#include <Eigen/Geometry>

namespace posewright {

/// Axis times angle (rad, 0 to π) of a rotation; NaN if R has one.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R);
/// Its inverse; NaN if v has one: an orientation that was not read is none.
Eigen::Matrix3d rotation_by(const Eigen::Vector3d& v);

}  // namespace posewright
