#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace posewright {

/// An orientation as three angles about axes in the order of their columns, pose.fixed_xyz.1, .2, .3 about axes that
/// stay and pose.moving_zyz.1, .2, .3 about axes that the turns before have moved. Any axes but the same twice in a
/// row.
struct EulerAngles {
  bool moving = false;
  std::array<int, 3> axes{};  ///< 0: x, 1: y, 2: z
  std::array<std::string, 3> columns;

  Eigen::Matrix3d rotation(const Eigen::Vector3d& angles) const;
};

/// The conventions whose three columns are all there.
std::vector<EulerAngles> euler_angles_of(const std::vector<std::string>& columns);

}  // namespace posewright
