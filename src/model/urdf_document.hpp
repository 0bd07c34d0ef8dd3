#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "urdf_lines.hpp"

namespace posewright {

/// A URDF file, parsed, and the way from the arm's base link to its tip link.
class UrdfDocument {
 public:
  /// @param place  where the problem file names the robot
  /// Throws InputError for an unreadable or malformed file and for links that are not there or not on one branch.
  UrdfDocument(const SerialArmSpec& arm, const SourcePlace& place);
  /// All of a file that is no robot: base and tip are its root.
  explicit UrdfDocument(const std::filesystem::path& file);
  /// All of an arm's file whatever its base and tip are: both are its root.
  static UrdfDocument whole(const SerialArmSpec& arm);

  const std::string& text() const { return text_; }
  const UrdfLines& lines() const { return lines_; }
  const urdf::ModelInterface& model() const { return *model_; }
  const std::string& base() const { return base_; }
  const std::string& tip() const { return tip_; }
  /// Joints from base to tip, fixed ones included.
  const std::vector<urdf::JointConstSharedPtr>& joints() const { return joints_; }

 private:
  UrdfDocument(std::string text, const std::string& name);

  std::string text_;
  UrdfLines lines_;
  urdf::ModelInterfaceSharedPtr model_;
  std::string base_, tip_;
  std::vector<urdf::JointConstSharedPtr> joints_;
};

Eigen::Isometry3d isometry(const urdf::Pose& pose);

}  // namespace posewright
