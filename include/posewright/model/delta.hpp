#pragma once

#include "posewright/model/closed_chain.hpp"

namespace posewright {

/// Delta robot: three arms at 0, 120 and 240 deg, a platform that keeps its attitude. Loop equation of one leg: g =
/// forearm − ‖x + platform_radius·d − base_radius·d − arm·(cos θ d − sin θ z)‖, θ = ρ + offset below the horizontal, d
/// the horizontal direction at `azimuth`.
///
/// Configuration: x, y, z of the platform's centre (m, base frame). Actuators leg_i.rho (rad). Own parameters, i = 1 …
/// 3: leg_i.{base_radius, platform_radius, arm, forearm} (m), leg_i.{offset, azimuth} (rad).
class Delta : public ClosedChain {
 public:
  explicit Delta(const DeltaSpec& spec);

 private:
  Eigen::Isometry3d do_platform(std::span<const double> q, Twists& freedoms) const override;
  bool do_inverse_kinematics(std::span<const double> q, std::span<const double> own,
                             std::span<double> actuators) const override;
  std::vector<Polyline> do_skeleton(std::span<const double> q, std::span<const double> actuators) const override;
  void do_loops(const LoopState& at, Loops& out) const override;
  bool do_loops_change(const LoopState& at, const Loops& slope, Twist& by_platform,
                       Eigen::VectorXd& by_actuators) const override;

  DeltaSpec spec_;
};

}  // namespace posewright
