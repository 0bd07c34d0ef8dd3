#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Prediction with the residuals, interpolated between the poses of the fit as a smooth effect.
struct Interpolation {
  std::string why_not;  ///< why it cannot be done; empty: it was
  std::string unit;     ///< of the readings that judge: lengths if there are any
  /// Root mean square over the poses, each left out of estimate and interpolation, per reading, SI.
  double alone = 0.0;         ///< by the parameters alone
  double interpolated = 0.0;  ///< with their residuals
  double gain = 0.0;          ///< mean of both squares' difference, paired, in its own standard errors
  /// Residuals of other poses after interpolation, SI, NaN if not read.
  std::vector<Eigen::VectorXd> others;

  /// Above two standard errors it is no accident.
  bool gains() const { return why_not.empty() && gain > 2.0; }
};

/// The best linear prediction of the effect u given the readings, û = Fᵀ Σ⁻¹ r with Σ = I + F Fᵀ of the whitened rows
/// (theory.md eq. (36)). Poses are left out without a new fit: with P = Σ⁻¹ − Σ⁻¹J (JᵀΣ⁻¹J)⁻¹ JᵀΣ⁻¹ pose i is missed by
/// e_i = P_ii⁻¹ (P r)_i (Dubrule 1983, Mathematical Geology 15(6)), and the parameters then are those of readings with
/// r_i − e_i in place of r_i. Linear at the estimate.
/// @param poses   those of the fit, which counted `effect`
/// @param others  poses that were not fitted
Interpolation interpolate(const IdentificationModel& model, const VariantColumns& columns,
                          const std::vector<MeasuredPose>& poses, const std::vector<MeasuredPose>& others,
                          const Fit& fit, const std::shared_ptr<const UnmodelledEffect>& effect);

}  // namespace posewright
