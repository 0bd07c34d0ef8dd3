#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "posewright/model/tip_model.hpp"

namespace posewright {

/// Over a box of configurations: d(q) = ‖J(q) T‖² of whitened blocks J, and functions that are not negative where q is
/// within reach and its actuators within their travel.
struct EnclosedModel {
  TaylorModel sensitivity;
  std::vector<TaylorModel> allowed;
};
/// @param q  every coordinate over the box
/// @param T  selected × any number; null: only the limits
/// @return false if the model has no enclosure
bool enclose(const IdentificationModel& model, std::span<const TaylorModel> q, std::span<const int> selected,
             const Eigen::MatrixXd* T, EnclosedModel& out);

/// d(q) = tr(Tᵀ F_ξᵀ (F_X Σ_X F_Xᵀ + F_ρ Σ_ρ F_ρᵀ)⁻¹ F_ξ T) over a box (theory.md eq. (7)).
/// @param covariance  Σ_X, along the twists of residual.platform; symmetric positive definite
/// @param noise  1σ of each reading; empty: exact
/// @param T  selected × any number
TaylorModel enclosed_sensitivity(const TipModel::EnclosedResidual& residual,
                                 const Eigen::Matrix<double, 6, 6>& covariance, const std::vector<double>& noise,
                                 const Eigen::MatrixXd& T);

}  // namespace posewright
