#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace posewright {

/// A problem for samples of hand-eye calibration: poses of the tip in the base and of the target in the camera.
struct SamplesProblem {
  std::string text;  ///< of the problem file; its robot is known by its poses
  bool on_hand = true;
  std::vector<int> wrong;          ///< ids of samples that do not fit the others; the frames are without them
  std::vector<std::string> notes;  ///< default choices, wrong samples
};

/// Finds camera and target by a linear fit without a start (calibration/hand_eye.hpp), and with that whether the camera
/// is on the hand, unless the file or `on_hand` says so.
/// @param file     samples that easy_handeye2 or MoveIt Calibration saved, or CSV with columns robot.* and pose.*
/// @param on_hand  the camera is; none: by the file, else whichever fits better
/// Throws InputError as the readers; CannotDo for fewer than three samples.
SamplesProblem samples_problem(const std::filesystem::path& file, std::optional<bool> on_hand);

}  // namespace posewright
