#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "posewright/model/serial_chain_kinematics.hpp"

namespace posewright {

/// Joints at which an arm's tip has a pose, and where its wrist stands: what controllers call status, configuration
/// data or CONFIG.
struct ArmBranch {
  std::array<double, 6> q{};  ///< rad, −π to π
  bool behind_base = false;   ///< the wrist's centre is behind the first axis
  bool behind_arm = false;    ///< it is behind the line through the second and third axis
};

/// Inverse kinematics of an arm as most six-axis robots are built: the last three axes meet in a point, the wrist's
/// centre; the second and third axis are parallel, and the first one is perpendicular to them. Front is where the
/// wrist's centre is at zero joints.
///
/// The first joint puts the centre into the arm's plane (two solutions), the law of cosines gives the third (two), the
/// wrist's middle joint follows from the angle between its outer axes (two); Newton's method on the chain as it is, for
/// origins that a URDF rounds.
///
/// Or as arms of Universal Robots are built: the fourth axis is parallel to the second and third, and the last two axes
/// meet in a point. There the sides of the wrist are not told.
class ArmInverse {
 public:
  using Joints = std::array<double, 6>;

  /// Throws CannotDo, with the reason, for another kind of arm.
  explicit ArmInverse(const ChainDescription& chain);

  /// Pose of the tip in the robot's base.
  Eigen::Isometry3d tip(const Joints& q) const;
  /// Joints near `q` at which the tip has the pose; false if Newton's method does not find them within 0.1 rad a step.
  bool polish(const Eigen::Isometry3d& X_BaseTip, Joints& q) const;
  /// All solutions, at most eight; none where the wrist's outer axes are in line.
  void solve(const Eigen::Isometry3d& X_BaseTip, std::vector<ArmBranch>& branches) const;

 private:
  void require_shape() const;
  void add_wrists(const Eigen::Isometry3d& target, const Joints& arm, ArmBranch branch,
                  std::vector<ArmBranch>& branches) const;
  /// Solutions with a first joint, at which the wrist is at `back` with that joint turned back.
  void add_parallel(const Eigen::Isometry3d& target, double q1, const Eigen::Vector3d& back,
                    std::vector<ArmBranch>& branches) const;
  /// @param third  about the second axis' direction
  bool is_behind_arm(double third) const;

  struct Axis {
    Eigen::Vector3d w, p;  ///< direction and a point, robot's base, at zero joints
  };
  std::array<Eigen::Isometry3d, 6> origins_;
  std::array<Eigen::Vector3d, 6> axes_;
  Eigen::Isometry3d X_LastTip_, zero_;
  std::array<Axis, 6> lines_;
  bool three_parallel_ = false;       ///< the second, third and fourth axis
  Eigen::Vector3d centre_, forward_;  ///< the wrist's at zero joints; horizontal, towards it
};

}  // namespace posewright
