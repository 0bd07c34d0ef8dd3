#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "posewright/problem/measurement_specs.hpp"

namespace posewright {

/// Pose of the board in the camera from one picture, by the homography of its plane (Zhang 2000, section 3.1), lens and
/// spacing nominal: millimetres off at half a metre, which shows whether a picture and a robot belong together.
/// @param pixels  u, v of each point, row by row of the board; NaN: not read
/// @return none for fewer than four points
std::optional<Eigen::Isometry3d> board_pose(const CameraMeasurement& camera, const Eigen::VectorXd& pixels);

}  // namespace posewright
