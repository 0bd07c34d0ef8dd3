#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pose_form.hpp"
#include "reading.hpp"

namespace posewright::programs {

enum class Angle { degrees, radians, pulses };

/// Files in which a name is the same point.
enum class Scope { file, stem, folder, all };

/// One row a language.
struct Language {
  std::string format;                ///< as `export` calls it
  std::vector<std::string> endings;  ///< of files, in small letters
  std::string code_ending;           ///< of files that have motions and need no points; empty: any has both
  std::vector<std::string> axes;     ///< empty: points name the robot's joints
  Angle angle = Angle::degrees;
  int decimals = 4;  ///< -1: as many as a number has
  bool needs_coupling = false;
  Scope scope = Scope::file;
  bool capitals = true;    ///< names are the same in capitals
  char taught_prefix = 0;  ///< begins names of points that are taught, whose motions are in another file
  Reading (*read)(const Source& source) = nullptr;
  const PoseForm& (*pose)() = nullptr;  ///< null: poses of this language are not compensated
};

const std::vector<Language>& languages();
/// Null: there is none of this format.
const Language* language_of(std::string_view format);

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
