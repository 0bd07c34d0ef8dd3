#include "repeatability.hpp"

namespace posewright {

int displacement_size(const Repeatability& repeatability) {
  if (repeatability.rotation > 0) return 6;
  return repeatability.translation > 0 ? 3 : 0;
}

void displacement_of_a_visit(const Repeatability& repeatability, const Eigen::Vector3d& p, Eigen::Ref<Twists> twists) {
  twists.setZero();
  for (Eigen::Index k = 0; k < twists.cols(); ++k) {
    if (k < 3) {
      twists(k, k) = repeatability.translation;
      continue;
    }
    const Eigen::Vector3d axis = repeatability.rotation * Eigen::Vector3d::Unit(k - 3);
    twists.col(k) << p.cross(axis), axis;
  }
}

}  // namespace posewright
