#pragma once

#include <limits>

#include "posewright/support/dense.hpp"

namespace posewright {

/// Φ of a singular design, negative.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Ratio of squared Cholesky pivots below which whitened information counts as singular.
inline constexpr double singular_pivot = 1e-11;

/// True if a Cholesky factor of whitened information is safely away from singular.
inline bool is_regular(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  if (factor.info() != Eigen::Success) return false;
  const auto pivots = factor.matrixLLT().diagonal();
  return pivots.minCoeff() * pivots.minCoeff() > singular_pivot * pivots.maxCoeff() * pivots.maxCoeff();
}

/// Added to the diagonal of a singular start. In whitened coordinates an average pose adds the identity, so this is a
/// thousandth of a pose.
inline constexpr double start_ridge = 1e-3;

}  // namespace posewright
