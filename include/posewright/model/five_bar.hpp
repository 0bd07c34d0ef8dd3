#pragma once

#include <cmath>

#include "posewright/model/closed_chain.hpp"

namespace posewright {

/// Loop equation of one leg of a planar five-bar, g = distal − ‖x − a − proximal·(cos, sin)(ρ + offset)‖.
/// @param leg  ax, ay, proximal, distal (m), offset (rad)
template <class T>
T five_bar_residual(const T& x, const T& y, const T& rho, const T* leg) {
  using std::cos, std::sin, std::sqrt;
  const T dx = x - leg[0] - leg[2] * cos(rho + leg[4]), dy = y - leg[1] - leg[2] * sin(rho + leg[4]);
  return leg[3] - sqrt(dx * dx + dy * dy);
}

/// What the elbow's sensor reads: angle from the proximal link to the distal one, less the sensor's own offset.
template <class T>
T five_bar_elbow(const T& x, const T& y, const T& rho, const T* leg, const T& sensor_offset) {
  using std::atan2, std::cos, std::sin;
  const T c = cos(rho + leg[4]), s = sin(rho + leg[4]);
  const T dx = x - leg[0] - leg[2] * c, dy = y - leg[1] - leg[2] * s;
  return atan2(c * dy - s * dx, c * dx + s * dy) - sensor_offset;
}

/// Planar five-bar in the x-y plane of its base; the platform is the point where the distal links meet.
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
  void do_loops(std::span<const double> q, std::span<const double> actuators, std::span<const double> own,
                std::span<const int> selected, Loops& out) const override;
  void do_sensors(std::span<const double> q, std::span<const double> actuators, std::span<const double> own,
                  std::span<const int> selected, Loops& out) const override;

  FiveBarSpec spec_;
};

}  // namespace posewright
