#pragma once

#include <vector>

#include "posewright/calibration/profile.hpp"
#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// Input of a calibration's profiles.
struct ProfiledFit {
  const IdentificationModel& model;
  const VariantColumns& columns;
  const std::vector<MeasuredPose>& poses;
  const FitOptions& options;
};

/// Profiles of some columns of a calibration.
struct ProfiledColumns {
  std::vector<int> columns;
  Profiles profiles;

  /// None: the column has no profile.
  const ProfileInterval* of(int column) const;
};

/// Columns that the options name; none: the curvature says which, or no profile is wanted. Throws InputError for a name
/// that matches no column.
std::vector<int> columns_to_profile(const CalibrateOptions& options, const VariantColumns& columns);

/// Profiles of the columns that were named, or that the curvature names; nothing for robust weights and where the
/// estimate has not converged. Columns that are angles of a frame have none, because their linear intervals are not
/// stated either. What is missing is said in calibration.notes.
/// @param named  columns_to_profile()
ProfiledColumns profiles_of(const ProfiledFit& fitted, const CalibrateOptions& options, const std::vector<int>& named,
                            double stretch, Calibration& calibration, const Monitor& monitor);

}  // namespace posewright
