#pragma once

#include <memory>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/measurement_model.hpp"

namespace posewright {

/// Closed-chain robots: g(X, ρ, ξ) = 0 ties the measured pose X of the platform to the actuators ρ. A robot gives the
/// rows of g; the instrument gives the covariance of X, whatever it measures, through the linear fit of X to its
/// readings:
///   Σ_X = (Yᵀ Σ_y⁻¹ Y)⁻¹,  Y = derivative of the readings along the six unit twists of the platform.
/// The covariance of the residual is then G_X Σ_X G_Xᵀ + G_ρ Σ_ρ G_ρᵀ, full: one pose enters every row.
class ImplicitModel : public IdentificationModel {
 protected:
  /// Throws CannotDo later, in linearise(), where the readings do not fix all six degrees of freedom.
  ImplicitModel(std::unique_ptr<MeasurementModel> measurement, double actuator_noise);

  /// Rows of one configuration: out.G = ∂g/∂ξ for `selected`; `g_pose` (r × 6) along spatial twists of the platform;
  /// `g_actuators` (r × actuators). False where q is unreachable.
  virtual bool do_rows(std::span<const double> q, std::span<const double> correction, std::span<const int> selected,
                       Eigen::MatrixXd& g, Eigen::Ref<Eigen::MatrixXd> g_pose,
                       Eigen::Ref<Eigen::MatrixXd> g_actuators) const = 0;

 private:
  bool do_linearise(std::span<const double> q, std::span<const double> correction, std::span<const int> selected,
                    Linearisation& out) const final;

  std::unique_ptr<MeasurementModel> measurement_;
  double actuator_noise_;
};

}  // namespace posewright
