#pragma once

#include <optional>
#include <string>

#include "posewright/formats/pose_formats.hpp"

namespace posewright {

/// Samples of hand-eye calibration: at each, the pose of the tip in the robot's base and the pose of the target in the
/// camera.
struct Samples {
  PoseTable table;              ///< columns robot.x … robot.qw, pose.x … pose.qw, id; texts; "nan": not measured
  std::optional<bool> on_hand;  ///< the camera is, by the file; none: the file does not say
};

/// Reads what easy_handeye2, MoveIt Calibration and cv::FileStorage save (YAML). None if the text is of neither. Throws
/// InputError with file and line.
std::optional<Samples> read_samples(const std::string& text, const std::string& file);
/// The table of these samples, else of CSV.
PoseTable samples_or_csv(const std::string& text, const std::string& file);

}  // namespace posewright
