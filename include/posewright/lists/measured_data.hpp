#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/calibration/lack_of_fit.hpp"
#include "posewright/calibration/orientation_form.hpp"
#include "posewright/calibration/platform_deformation.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Readings as a user's file has them, for one model.
struct MeasuredData {
  std::vector<MeasuredPose> poses;         ///< in the file's order; rows of one configuration averaged
  std::vector<int> lines;                  ///< of the file, of each pose's first row
  std::vector<bool> held_back;             ///< per pose: for validation only (column `use`)
  int rows = 0;                            ///< of the file
  double repeats = 1.0;                    ///< rows per pose, harmonic mean
  bool same_repeats = true;                ///< whether every pose has as many rows
  std::vector<double> spread;              ///< standard deviation of each reading within a pose; empty without repeats
  std::vector<RepeatedReadings> repeated;  ///< poses of more than one row
  std::vector<PlatformImage> images;       ///< of a six-legged platform whose joint centres are read, too; row by row
  OrientationForm orientation{};           ///< as the columns have it
  std::vector<std::string> notes;          ///< notes on the reading, for the user
};

/// CSV with a header: one column for every coordinate as in a list of poses (names, maybe with units), one for every
/// reading of the model (`P1.x [mm]`); an empty cell was not read. Columns `id` (or `pose`) and `use` (fit | validate)
/// may be there; others are passed over. Rows in a row with one configuration (to 1e-5 rad or m; under one id to 1e-3)
/// are repeats and are averaged: their `reading_share` says of how many, against the problem's repeats. Without such
/// rows every row is the mean of the problem's repeats. Actuators may stand for the coordinates of a parallel robot.
/// Orientations as rotation vectors (pose.rx, …), unit quaternions (pose.qx, pose.qy, pose.qz, pose.qw) or three angles
/// (OrientationColumns), of a list's instrument as rotation vectors alone; photogrammetric points of a pose (NAME.x, …)
/// become the pose by rigid fit. Joint centres of a platform (leg_1.x, …) beside its points make images of how it
/// deforms. Throws InputError with file and line.
MeasuredData read_measured_data(const std::filesystem::path& file, const Problem& problem,
                                const IdentificationModel& model);
/// Overload for text in memory; `file` names it in messages.
MeasuredData parse_measured_data(const std::string& text, const std::filesystem::path& file, const Problem& problem,
                                 const IdentificationModel& model);

/// Text in the same format, SI, values to their last digit.
std::string measured_data_csv(const IdentificationModel& model, const std::vector<MeasuredPose>& poses);

/// Points of a platform that are read beside its pose: those that make the rigid body, and columns `leg_i.x`,
/// `leg_i.y`, `leg_i.z` of the joint centres.
struct PlatformPoints {
  std::vector<TargetSpec> body;
  double noise = 0.0;               ///< 1σ of a coordinate, m
  std::vector<std::string> joints;  ///< "leg_1", …
};

/// Empty for robots without six legs and instruments without points of the platform.
std::optional<PlatformPoints> platform_points(const RobotSpec& robot, const MeasurementSpec& measurement,
                                              const IdentificationModel& model);

/// Actuator positions less those of the nominal robot at the reference. Empty if q is out of reach.
Eigen::VectorXd actuator_moves(const IdentificationModel& model, const std::vector<double>& q);

}  // namespace posewright
