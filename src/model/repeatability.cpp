#include "repeatability.hpp"

namespace posewright {

int displacement_size(const Repeatability& repeatability) {
  if (repeatability.rotation > 0) return 6;
  return repeatability.translation > 0 ? 3 : 0;
}

Twist unit_displacement(const Eigen::Vector3d& p, int k) {
  Twist twist = Twist::Unit(k);
  if (k >= 3) twist.head<3>() = p.cross(Eigen::Vector3d::Unit(k - 3));
  return twist;
}

void displacement_of_a_visit(const Repeatability& repeatability, const Eigen::Vector3d& p, Eigen::Ref<Twists> twists) {
  for (Eigen::Index k = 0; k < twists.cols(); ++k)
    twists.col(k) = (k < 3 ? repeatability.translation : repeatability.rotation) * unit_displacement(p, int(k));
}

}  // namespace posewright
