#pragma once

#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Root mean square of the whitened readings of each pose of a robot drawn from all tolerances of the model, whatever
/// is estimated: √((n + tr(J T² Jᵀ))/n) of n readings, at least 1.
/// @param columns  those that are estimated, whose tolerances may be stated
std::vector<double> explained_sizes(const IdentificationModel& model, const VariantColumns& columns,
                                    const std::vector<MeasuredPose>& poses, const std::vector<double>& correction);

/// Root mean square of whitened residuals over all readings.
double residual_rms(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                    const std::vector<double>& correction);

/// Root mean square that noise and all tolerances explain where base, tool and targets are fitted, at least 1. Boards
/// of a camera stand where each picture shows them: a wrong convention puts them behind the camera or beside the
/// picture, where points and lens have derivatives without limit.
/// @param columns  those that are estimated, whose tolerances may be stated
double explained_rms(const MeasurementSpec& measurement, const IdentificationModel& model,
                     const VariantColumns& columns, const std::vector<MeasuredPose>& poses,
                     const std::vector<double>& correction);

/// Residuals against what explains them: residual_rms() and explained_rms().
struct ResidualSize {
  double found = 0.0, explained = 0.0;
  /// Three times: a convention that the file does not keep may be the cause.
  bool unusual() const { return found > 3.0 * explained; }
  /// Beyond ten times: no error of a robot gives them.
  bool beyond_robots() const { return found > 10.0 * explained; }
};

/// A pose whose readings no error of the robot gives.
struct GrossPose {
  int id = 0;
  double size = 0.0;       ///< root mean square of its whitened residuals, placed by the others
  double explained = 0.0;  ///< explained_sizes() of it
};

/// Fewer than a quarter of the poses that lie beyond ten times what noise and tolerances explain, five times the median
/// of all, while the others are within three times what they explain once these are left out; largest first. Empty if
/// there are none, or if the others do not fit either.
/// @param options  of the placing fit; its start: things placed
std::vector<GrossPose> gross_poses(const IdentificationModel& model, const VariantColumns& columns,
                                   const std::vector<MeasuredPose>& poses, const FitOptions& options);

}  // namespace posewright
