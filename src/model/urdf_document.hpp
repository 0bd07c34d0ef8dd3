#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "urdf_tree.hpp"

namespace posewright {

/// A joint on the way from base to tip; backward: from its child to its parent.
struct UrdfStep {
  const UrdfJoint* joint = nullptr;
  bool backward = false;

  /// From one link of the joint to the other in the direction of the way, where it is held, else at zero.
  Eigen::Isometry3d origin() const { return backward ? joint->X_ParentChild().inverse() : joint->X_ParentChild(); }
};

/// A URDF file, parsed, and the way from the arm's base link to its tip link: up to the link that both hang on, and
/// down. Of an arm with several ways base and tip are the root, and `moving` has the joints.
class UrdfDocument {
 public:
  /// Joints that the arm holds do not move.
  /// @param place  where the problem file names the robot
  /// Throws InputError for an unreadable or malformed file, for links that are not there and joints that cannot be
  /// held.
  UrdfDocument(const SerialArmSpec& arm, const SourcePlace& place);
  /// All of a file that is no robot: base and tip are its root.
  explicit UrdfDocument(const std::filesystem::path& file);
  /// All of an arm's file whatever its base and tip are: both are its root.
  static UrdfDocument whole(const SerialArmSpec& arm);

  const std::string& text() const { return text_; }
  const UrdfTree& tree() const { return tree_; }
  const UrdfLink& base() const { return *base_; }
  const UrdfLink& tip() const { return *tip_; }
  /// Joints from base to tip, fixed ones included; those backward come first.
  const std::vector<UrdfStep>& way() const { return way_; }
  /// Joints that move on any of several ways, parents before children.
  const std::vector<const UrdfJoint*>& moving() const { return moving_; }
  /// True if a joint that moves is backward: the base moves in the robot's own root.
  bool moves_base() const;

 private:
  UrdfDocument(std::string text, const std::string& name);
  void take_ways(const SerialArmSpec& arm, const SourcePlace& place);

  std::string text_;
  UrdfTree tree_;
  const UrdfLink *base_, *tip_;
  std::vector<UrdfStep> way_;
  std::vector<const UrdfJoint*> moving_;
};

}  // namespace posewright
