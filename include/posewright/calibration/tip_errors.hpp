#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Largest error of the tip along or about one axis over many poses.
struct LargestTipError {
  std::string axis;  ///< "x", "y", "z" (m), "rx", "ry", "rz" (rad: components of the rotation vector)
  std::string unit;  ///< "m", "rad"
  int count = 0;     ///< poses, or targets where these are judged one by one
  double largest = 0.0;
  int pose = 0;           ///< id where it is
  double by_noise = 0.0;  ///< in 95 of 100 runs noise alone makes no error larger than this
};

/// Displacement and rotation of the tip that fit the residuals of each pose best, δ = (Tᵀ Σ⁻¹ T)⁻¹ Tᵀ Σ⁻¹ r with the
/// tip's columns T (IdentificationModel::tip_column) and the covariance Σ of the readings; in the axes of the
/// measurement frame. Where no pose determines all six (one target), targets are judged one by one instead. Empty for
/// instruments that see neither.
/// @param residuals  measured less predicted at `correction`
std::vector<LargestTipError> tip_errors(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                        const Fit& fit, const std::vector<double>& correction,
                                        const std::vector<Eigen::VectorXd>& residuals);

}  // namespace posewright
