#pragma once

#include <Eigen/Dense>

namespace posewright {

/// Ratio of squared Cholesky pivots below which whitened information counts as singular.
inline constexpr double singular_pivot = 1e-11;

/// Whether a Cholesky factor of whitened information is safely away from singular.
inline bool is_regular(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  if (factor.info() != Eigen::Success) return false;
  const auto pivots = factor.matrixLLT().diagonal();
  return pivots.minCoeff() * pivots.minCoeff() > singular_pivot * pivots.maxCoeff() * pivots.maxCoeff();
}

}  // namespace posewright
