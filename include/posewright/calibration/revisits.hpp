#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/calibration/residual_statistics.hpp"

namespace posewright {

/// Configurations that were measured again after others: each time a pose of its own in the fit, since robot and
/// instrument came back. Differences of visits are noise and drift, for any model of the robot.
struct Revisits {
  int places = 0, visits = 0;  ///< configurations that were visited more than once, and how often in all
  /// Differences between visits in units of the stated noise (instrument and repeatability), drift taken out.
  double noise = 0.0;
  TestResult larger;  ///< χ² of them: that chance alone makes them as large
  TestResult drift;   ///< F: readings that move evenly with their number in the file
  struct Moved {
    std::string reading, unit;
    double change = 0.0;  ///< from the first pose to the last, SI
  };
  std::vector<Moved> moved;  ///< of the drift, every reading; empty: too few visits to tell
};

/// Least squares of y = μ_place + d t + ε over all visits, rows whitened by the stated covariance of each: t is the
/// pose's place in the list. Readings that not all visits of a place have do not count for it.
/// @param poses       in the order of measurement
/// @param correction  of all parameters
Revisits revisits(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                  const std::vector<double>& correction);

}  // namespace posewright
