#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace posewright {

/// An orientation as three turns about axes in this order: about axes that stay, or about axes that the turns before
/// have moved. Any axes but the same twice in a row.
struct EulerTurns {
  bool moving = false;
  std::array<int, 3> axes{};  ///< 0: x, 1: y, 2: z

  Eigen::Matrix3d rotation(const Eigen::Vector3d& angles) const;
  /// Its inverse, the middle angle from −90 to 90 deg, or from 0 to 180 deg where first and last axis are the same.
  Eigen::Vector3d angles(const Eigen::Matrix3d& R) const;
  /// "moving_zyx", as columns are named.
  std::string name() const;
};

}  // namespace posewright
