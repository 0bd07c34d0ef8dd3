#pragma once

#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Noise of the instruments of a list as their residuals show it.
struct InstrumentNoise {
  std::vector<double> factors;  ///< of the stated 1σ of each, at least 1
  double probability = 1.0;     ///< that chance alone gives as large a gain of the likelihood

  bool shown() const { return probability < seldom; }

  static constexpr double seldom = 0.01;
};

/// Variance components by restricted maximum likelihood (Patterson and Thompson 1971, Biometrika 58), linear about a
/// fit:
///
///   −2 ln L = Σ_k n_k ln s_k² + ln |M| + Σ_k |r_k|²/s_k² + x̂ᵀP x̂,   M = Σ_k J_kᵀJ_k/s_k² + P
///
/// for the n_k readings of instrument k, whitened by its stated covariance; P is of the tolerances that count, with the
/// spreads of the fit. A stationary point is s_k² = |r_k|²/(n_k − tr(M⁻¹J_kᵀJ_k)/s_k²), which is iterated with s_k ≥ 1:
/// a few readings that scatter little make no instrument better than stated.
/// An instrument whose readings alone agree with its stated noise keeps it: what another one errs by, a wrong camera or
/// an effect that no parameter describes, is not blamed on it. Where each agrees with itself and not with the others,
/// all s_k are sought.
/// @param poses  of the fit
/// Returns no factors for a model without a list of instruments.
InstrumentNoise instrument_noise(const IdentificationModel& model, const VariantColumns& columns,
                                 const std::vector<MeasuredPose>& poses, const Fit& fit, Prior prior);

}  // namespace posewright
