#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Errors along one axis, or of a whole target or pose, over many poses. SI.
struct AxisErrors {
  std::string axis;  ///< "x" … "rz": readings of that name; "distance", "angle": see errors_by_axis()
  std::string unit;  ///< "m", "rad"
  int count = 0;
  double mean = 0.0, deviation = 0.0;  ///< of the errors; deviation: about the mean
  double rms = 0.0, largest = 0.0;
  int pose = 0;  ///< id where the largest is
};

/// Readings of positions and orientations axis by axis, in the axes that the instrument reads in. `distance`: norm of
/// x, y, z of every target (or pose). Orientations (`rx`, `ry`, `rz` and their norm `angle`): as read, or, where three
/// or more targets of a pose are read that are not in a line, the turn that takes the predicted targets to the measured
/// ones (rigid_fit()). Empty for instruments that read neither.
/// @param residuals  measured less predicted, as residuals_of() gives them
std::vector<AxisErrors> errors_by_axis(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                       const std::vector<Eigen::VectorXd>& residuals);

/// Error of one pose: root mean square over its targets of the norm of x, y, z (m), and norm of the turn (rad).
struct PoseError {
  double position = 0.0, rotation = 0.0;  ///< NaN if nothing of that kind is read
};

/// Errors of the poses by the covariance of the estimate, J C Jᵀ, in the rows that were read, and the same with the
/// noise of the readings themselves: J C Jᵀ + s² V, s = fit.noise_factor (or fit.scale where the residuals told the
/// noise). For poses that were not fitted. Klimchik et al. (2013), Tables X and XII, have it as "model".
struct PredictedError {
  PoseError by_estimate, with_noise;
};
std::vector<PredictedError> predicted_errors(const IdentificationModel& model, const VariantColumns& columns,
                                             const std::vector<MeasuredPose>& poses, const Fit& fit);
/// Observed error of a pose from its residuals, noise included. Orientations as read.
std::vector<PoseError> observed_errors(const IdentificationModel& model, const std::vector<Eigen::VectorXd>& residuals);

}  // namespace posewright
