#include "posewright/model/euler_turns.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace posewright {

Eigen::Matrix3d EulerTurns::rotation(const Eigen::Vector3d& angles) const {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angles[Eigen::Index(k)], Eigen::Vector3d::Unit(axes[k])).toRotationMatrix();
    R = moving ? Eigen::Matrix3d(R * turn) : Eigen::Matrix3d(turn * R);
  }
  return R;
}

Eigen::Vector3d EulerTurns::angles(const Eigen::Matrix3d& R) const {
  // Turns about axes that stay are those about moving ones from the last to the first.
  const auto a = moving ? axes : std::array<int, 3>{axes[2], axes[1], axes[0]};
  Eigen::Vector3d found = R.eulerAngles(a[0], a[1], a[2]);
  const bool outside = a[0] == a[2] ? found[1] < 0 : std::abs(found[1]) > std::numbers::pi / 2;
  if (outside) {
    const double turn = std::numbers::pi;
    found = {found[0] + turn, a[0] == a[2] ? -found[1] : turn - found[1], found[2] + turn};
    for (double& angle : found) angle = std::remainder(angle, 2 * turn);
  }
  if (!moving) std::swap(found[0], found[2]);
  return found;
}

std::string EulerTurns::name() const {
  std::string text = moving ? "moving_" : "fixed_";
  for (const int axis : axes) text += "xyz"[axis];
  return text;
}

}  // namespace posewright
