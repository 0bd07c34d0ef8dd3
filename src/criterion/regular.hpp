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

/// ln det of the Schur complement of the last `interest` rows and columns of L Lᵀ.
inline double log_det_of_last(const Eigen::LLT<Eigen::MatrixXd>& factor, Eigen::Index interest) {
  return 2 * factor.matrixLLT().diagonal().tail(interest).array().log().sum();
}

/// Φ with a block J more than L Lᵀ, whose Φ is `value`: ln det(I + ZᵀZ) − ln det(I + Z_nᵀZ_n) more, Z = L⁻¹Jᵀ, Z_n its
/// first `nuisance` rows.
inline double log_det_with_block(double value, const Eigen::MatrixXd& Z, Eigen::Index nuisance) {
  const Eigen::Index r = Z.cols();
  const auto with_one = [&](Eigen::MatrixXd product) {
    product.diagonal().array() += 1;
    return log_det_of_last(Eigen::LLT<Eigen::MatrixXd>(product), r);
  };
  Eigen::MatrixXd product = Z.topRows(nuisance).transpose() * Z.topRows(nuisance);
  const double of_nuisance = with_one(product);
  product.noalias() += Z.bottomRows(Z.rows() - nuisance).transpose() * Z.bottomRows(Z.rows() - nuisance);
  return value + with_one(product) - of_nuisance;
}

/// Added to the diagonal of a singular start. In whitened coordinates an average pose adds the identity, so this is a
/// thousandth of a pose.
inline constexpr double start_ridge = 1e-3;

}  // namespace posewright
