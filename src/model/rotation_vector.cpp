#include "posewright/model/rotation_vector.hpp"

#include <cmath>
#include <limits>

namespace posewright {

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  if (!R.allFinite()) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d rotation_by(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  if (std::isnan(angle)) return Eigen::Matrix3d::Constant(angle);
  if (!(angle > 0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

}  // namespace posewright
