#pragma once

#include "posewright/model/closed_chain.hpp"

namespace posewright {

/// Planar five-bar in the x-y plane of its base; the platform is the point where the distal links meet. Loop
/// equation of one leg: g = distal − ‖x − a − proximal·(cos, sin)(ρ + offset)‖; its elbow reads the angle from the
/// proximal link to the distal one, less the sensor's own offset.
///
/// Configuration: x, y of that point (m, base frame). Actuators leg_i.rho (rad). Own parameters, i = 1, 2:
/// leg_i.{ax, ay, proximal, distal} (m), leg_i.{offset, sensor_offset} (rad). Redundant sensors: leg_i.elbow (rad).
class FiveBar : public ClosedChain {
 public:
  explicit FiveBar(const FiveBarSpec& spec);

 private:
  Eigen::Isometry3d do_platform(std::span<const double> q, Twists& freedoms) const override;
  bool do_inverse_kinematics(std::span<const double> q, std::span<const double> own,
                             std::span<double> actuators) const override;
  std::vector<Polyline> do_skeleton(std::span<const double> q, std::span<const double> actuators) const override;
  void do_loops(const LoopState& at, Loops& out) const override;
  bool do_loops_change(const LoopState& at, const Loops& slope, Twist& by_platform,
                       Eigen::VectorXd& by_actuators) const override;
  void do_sensors(const LoopState& at, Loops& out) const override;

  FiveBarSpec spec_;
};

}  // namespace posewright
