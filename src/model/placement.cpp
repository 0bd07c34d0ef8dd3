#include "posewright/model/placement.hpp"

namespace posewright {

Eigen::Matrix3d rotation_of_rpy(const Eigen::Vector3d& rpy) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Isometry3d isometry(const Placement& placement) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = rotation_of_rpy(placement.rpy);
  X.translation() = placement.position;
  return X;
}

}  // namespace posewright
