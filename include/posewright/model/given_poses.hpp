#pragma once

#include "posewright/model/tip_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// A robot that is known by the poses of its tip alone, as its controller reports them: for calibrations of what it
/// carries and what stands before it (hand-eye, tool, work frame).
///
/// Configuration: robot.x, .y, .z (m), robot.roll, .pitch, .yaw (rad), the tip in the robot's base:
/// Trans(x, y, z) Rz(yaw) Ry(pitch) Rx(roll).
/// Parameters base.{x, …, rz} (displacement of the base in M) and tool.{x, …, rz} (of the tool frame on the tip).
class GivenPoses : public TipModel {
 public:
  GivenPoses(const GivenPosesSpec& spec, const std::vector<CoordinateLimits>& pose_limits);

  bool linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip, Twists& twists,
                 Twists* reading_twists) const override;

 private:
  Eigen::Isometry3d X_MeasureBase_, X_TipTool_;
};

}  // namespace posewright
