#pragma once

#include <optional>
#include <string>
#include <vector>

#include "language.hpp"

namespace posewright::programs {

/// Frames of a pose: base and tool.
struct PlacedFrames {
  Eigen::Isometry3d X_BaseUser = Eigen::Isometry3d::Identity();  ///< of the pose, in the robot's base
  Eigen::Isometry3d X_TipTool = Eigen::Isometry3d::Identity();   ///< that is at the pose, in the robot's tip
};

/// Finds values of the frames that programs name: stated in place, in one of the files, or given by the user.
class FrameValues {
 public:
  explicit FrameValues(const ProgramFrames& given) : given_(given) {}
  void add(const Language& language, const Reading& reading);

  /// @param why  set if a value is missing
  std::optional<PlacedFrames> of(const Language& language, const FramePair& frames, std::string& why) const;

 private:
  /// The name behind that of a motion's data.
  FrameName named(const Language& language, const FrameName& frame, bool tool) const;
  std::optional<std::vector<double>> values(const Language& language, const FrameName& named, bool tool) const;

  ProgramFrames given_;
  std::map<std::string, std::vector<double>> values_;  ///< by format and name
  std::map<std::string, FramePair> data_;
};

}  // namespace posewright::programs
