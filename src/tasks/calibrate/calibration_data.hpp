#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/conventions.hpp"
#include "posewright/calibration/fit.hpp"
#include "posewright/lists/measured_data.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// All that a calibration is given to read. Where there are several files, each is a campaign: the last coordinate of
/// every configuration says which (with_campaigns()).
struct CalibrationData {
  std::vector<MeasuredPose> fitted, held_back;  ///< campaigns one after the other
  std::vector<MeasuredPose> validation;         ///< those held back that come from a file of their own
  std::vector<RepeatedReadings> repeated;
  std::vector<PlatformImage> images;
  OrientationForm orientation{};  ///< of the first file
};

/// Names of the campaigns: the files' without folder and ending, numbered where two are alike; empty: one file.
std::vector<std::string> campaigns_of(const CalibrateOptions& options);

/// Frames that stand elsewhere in each further campaign, as their parameters begin: "base", "tool", "target.P1".
/// @param moved  not automatic
std::vector<std::string> moved_frames(const MeasurementSpec& measurement, Moved moved);

/// Reads the files and says in `result` how many rows and poses there are and what the user must know of them.
/// @param model  of one campaign
/// Throws InputError with file and line.
CalibrationData read_calibration_data(const Problem& problem, const CalibrateOptions& options,
                                      const IdentificationModel& model, Calibration& result);

/// Throws CannotDo with the poses whose readings no robot gives while the others fit: an estimate would go astray.
/// Robust weights leave them aside.
/// @param notes  on the file, said with it
void refuse_gross_poses(const IdentificationModel& model, const VariantColumns& columns,
                        const std::vector<MeasuredPose>& poses, const std::vector<double>& placed, FitOptions options,
                        const std::vector<std::string>& notes);

/// Throws CannotDo with the poses at which targets were read as each other.
void refuse_mixed_targets(const MeasurementSpec& measurement, const std::vector<MeasuredPose>& poses,
                          Weighting weighting);

/// Throws CannotDo with the convention that the file does not keep: parameters would bend the robot to it.
void refuse_conventions(const Problem& problem, const IdentificationModel& model, const VariantColumns& columns,
                        const std::vector<MeasuredPose>& poses, const std::vector<double>& placed,
                        const OrientationForm& orientation);

/// The same where base and tool could not be fitted at all; nothing if no convention explains it.
void refuse_unplaced(const Problem& problem, const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                     const OrientationForm& orientation);

}  // namespace posewright
