#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/model/tip_model.hpp"

namespace posewright {

/// d(q) = tr(Tᵀ F_ξᵀ (F_X Σ_X F_Xᵀ + F_ρ Σ_ρ F_ρᵀ)⁻¹ F_ξ T) over a box (theory.md eq. (7)).
/// @param covariance  Σ_X, along the twists of residual.platform; symmetric positive definite
/// @param noise  1σ of each reading; empty: exact
/// @param T  selected × any number
TaylorModel enclosed_sensitivity(const TipModel::EnclosedResidual& residual,
                                 const Eigen::Matrix<double, 6, 6>& covariance, const std::vector<double>& noise,
                                 const Eigen::MatrixXd& T);

}  // namespace posewright
