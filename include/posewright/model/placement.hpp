#pragma once

#include <Eigen/Geometry>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// R = Rz(yaw) Ry(pitch) Rx(roll), as URDF origins.
Eigen::Matrix3d rotation_of_rpy(const Eigen::Vector3d& rpy);
/// Its inverse, pitch from −90 to 90 deg. Roll and pitch are the rest of R without that yaw, so that they stay
/// right where pitch is a right angle and yaw could be any.
Eigen::Vector3d rpy_of(const Eigen::Matrix3d& R);
Eigen::Isometry3d isometry(const Placement& placement);

}  // namespace posewright
