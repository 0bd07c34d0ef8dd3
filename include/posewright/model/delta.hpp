#pragma once

#include <cmath>

#include "posewright/model/closed_chain.hpp"

namespace posewright {

/// Loop equation of one leg of a delta robot, g = forearm − ‖x + platform_radius·d − base_radius·d − arm·(cos θ d −
/// sin θ z)‖, θ = ρ + offset below the horizontal, d the horizontal direction at `azimuth`.
/// @param x    platform centre in the base frame (m)
/// @param leg  base_radius, platform_radius, arm, forearm (m), offset, azimuth (rad)
template <class T>
T delta_residual(const T* x, const T& rho, const T* leg) {
  using std::cos, std::sin, std::sqrt;
  const T theta = rho + leg[4];
  const T radial = leg[1] - leg[0] - leg[2] * cos(theta);
  const T hx = x[0] + radial * cos(leg[5]), hy = x[1] + radial * sin(leg[5]), hz = x[2] + leg[2] * sin(theta);
  return leg[3] - sqrt(hx * hx + hy * hy + hz * hz);
}

/// Delta robot: three arms at 0, 120 and 240 deg, a platform that keeps its attitude.
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
  void do_loops(std::span<const double> q, std::span<const double> actuators, std::span<const double> own,
                std::span<const int> selected, Loops& out) const override;

  DeltaSpec spec_;
};

}  // namespace posewright
