#pragma once

#include <Eigen/Geometry>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// R = Rz(yaw) Ry(pitch) Rx(roll), as URDF origins.
Eigen::Matrix3d rotation_of_rpy(const Eigen::Vector3d& rpy);
Eigen::Isometry3d isometry(const Placement& placement);

}  // namespace posewright
