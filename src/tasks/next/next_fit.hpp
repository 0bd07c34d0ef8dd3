#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/forecast.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/next_poses.hpp"

namespace posewright {

/// Estimate of a robot from the measured poses.
struct NextFit {
  Problem problem;  ///< at the estimated values, with the effect that the residuals show
  std::vector<MeasuredPose> poses;
  std::vector<int> lines;  ///< of the file, of each pose
  int readings = 0;        ///< single ones that were read
  bool fitted = false;     ///< else at nominal values
  ForecastNoise noise;
  FittedResiduals residuals;
  double scale = 1.0, freedom = 0.0;  ///< of the residuals, in units of the stated noise
  std::optional<CalibratedEffect> effect{};
  std::vector<EstimatedValue> estimates{};
  std::vector<std::string> notes{};
};

/// Throws InputError with the file's line for what cannot be read, and for a pose that is so far from where the fit of
/// those before it says that it is no reading of this robot.
NextFit fit_so_far(const Problem& problem, const NextOptions& options, const Monitor& monitor);

}  // namespace posewright
