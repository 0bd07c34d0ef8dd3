#pragma once

#include <array>

#include "posewright/model/closed_chain.hpp"

namespace posewright {

/// Six-legged parallel robot: with prismatic base actuators (6-PUS, e.g. a telescope's secondary mirror) or legs of
/// variable length (Gough/Stewart platform). Loop equation of one leg (theory.md eq. (8)):
///   g = l + extension − ‖p + R (b + lift·z) − a − slide·u‖;
/// a leg with a prismatic base joint slides, a leg of variable length extends; lift is the platform's deformation at b.
///
/// Configuration: x, y, z (m) added to the reference position, rx, ry, rz (rad): R = Rz Ry Rx R_reference. Own
/// parameters: leg_i.{ax, ay, az, bx, by, bz, ux, uy, l}, i = 1 … 6 (no ux, uy for a Gough platform); a in the base
/// frame, b in the platform's. A 6-PUS adds the deformation of the platform by the actuators' positions,
///   Δb_i = ((kappa + kappa_i) Δρ_i + Σ_j K_ij Δρ_j) z,   Δρ = ρ − ρ⁰,
/// ρ⁰ the actuators of the nominal robot at the reference; kappa_i as in eq. (7), K as in eq. (8) of the telescope's
/// study, kappa one for all legs. All zero unless a variant's nominal values say otherwise. Actuators leg_i.rho by
/// inverse kinematics, of the two solutions the lower.
class SixLegs : public ClosedChain {
 public:
  SixLegs(const SixLegsSpec& spec, const std::vector<CoordinateLimits>& pose_limits);

 private:
  Eigen::Isometry3d do_platform(std::span<const double> q, Twists& freedoms) const override;
  bool do_inverse_kinematics(std::span<const double> q, std::span<const double> own,
                             std::span<double> actuators) const override;
  std::vector<Polyline> do_skeleton(std::span<const double> q, std::span<const double> actuators) const override;
  void do_loops(const LoopState& at, Loops& out) const override;
  bool do_loops_change(const LoopState& at, const Loops& slope, Twist& by_platform,
                       Eigen::VectorXd& by_actuators) const override;
  bool do_enclose(std::span<const TaylorModel> q, std::span<const double> own, std::span<const int> selected,
                  Enclosed& out) const override;

  template <class S>
  void loops_at(const Frame<S>& platform, std::span<const S> rho, std::span<const double> own,
                std::span<const int> selected, LoopsOf<S>& out) const;
  std::vector<TaylorModel> enclosed_actuators(const Frame<TaylorModel>& platform, std::span<const double> own,
                                              std::span<const TaylorModel> lifts,
                                              std::vector<TaylorModel>& allowed) const;
  bool enclose_lifted(const Frame<TaylorModel>& platform, std::span<const double> own, Enclosed& out) const;
  Eigen::Isometry3d platform_pose(std::span<const double> q) const;

  SixLegsSpec spec_;
  Eigen::Isometry3d X_BaseReference_;
  std::array<double, 6> reference_rho_{};
  int per_leg_ = 9;
};

}  // namespace posewright
