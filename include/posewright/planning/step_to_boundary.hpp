#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace posewright {

/// Largest step ≤ 1 that takes no entry of x > 0 more than this share of its way to 0 along dx.
inline double step_to_boundary(const Eigen::VectorXd& x, const Eigen::VectorXd& dx, double share) {
  double step = 1.0;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (dx[i] < 0) step = std::min(step, -share * x[i] / dx[i]);
  return step;
}

}  // namespace posewright
