#pragma once

#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/calibration/residual_statistics.hpp"

namespace posewright {

/// Repeated readings without motion.
struct RepeatedReadings {
  std::vector<double> q;
  Eigen::MatrixXd deviations;  ///< readings × rows of the data: each less their mean, SI; NaN if not read
};

/// Residuals of poses against the scatter of the readings within them *and* the stated repeatability.
///
/// With E the covariance of one reading (up to one factor s²) and C = S + E/n that of a pose's mean: s² = Σ‖E^{-1/2}
/// d‖²/ν over all deviations d, ν = (rows − 1) a reading; V = S + s² E/n; F = Σ rᵀ V⁻¹ r/f with f the fit's degrees of
/// freedom. Where nothing stays at a pose F is exactly Fisher's (f, ν). Otherwise only the share φ = Σ tr(V⁻¹ s² E/n)/Σ
/// rows of V rests on s², so that the variance of its logarithm is φ² 2/ν: (f, ν/φ²) after Satterthwaite 1946.
/// @param model       that was fitted: C
/// @param instrument  without repeatability: E/n
/// @param measurement  says how many readings a pose both count with
/// f is Fit::left. Not possible if nothing was read twice, without degrees of freedom, and for robust fits.
TestResult lack_of_fit(const IdentificationModel& model, const IdentificationModel& instrument,
                       const MeasurementSpec& measurement, const std::vector<MeasuredPose>& poses,
                       const std::vector<RepeatedReadings>& repeated, const Fit& result);

}  // namespace posewright
