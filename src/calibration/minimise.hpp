#pragma once

#include <Eigen/Core>

#include "posewright/support/monitor.hpp"
#include "stacked_readings.hpp"

namespace posewright {

struct MinimiseOptions {
  /// Relative, of the sum of squares and of the step; 1e-11 is far below the noise and well above rounding.
  double tolerance = 1e-11;
  int most_evaluations = 200;  ///< of the residuals
  int held = -1;               ///< column that stays where it is; −1: none
  const Monitor* monitor = nullptr;
};

/// Minimises the sum of squared residuals from x on by Levenberg–Marquardt (Moré 1978, Eigen's port of MINPACK); false
/// if it stopped for another reason than having arrived.
/// @param evaluations  more by as many as were needed
bool minimise(StackedReadings& stacked, const MinimiseOptions& options, Eigen::VectorXd& x, int& evaluations);

}  // namespace posewright
