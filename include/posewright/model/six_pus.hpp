#pragma once

#include "posewright/model/implicit_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// One leg's parameters in the scalar type T: base joint a, platform joint b, actuator direction u, length l.
template <class T>
struct LegParameters {
  T a[3], b[3], u[2], l;  ///< u without its third component, which is √(1 − ux² − uy²) with the nominal sign
};

/// Residual of one leg, g = l − ‖p + R b − a − ρ u‖, design §3.4 (Gough platform with inclined base actuators).
/// @param p, R    platform pose in the base frame (m; row-major rotation)
/// @param u_sign  sign of the third component of u
template <class T>
T leg_residual(const T* p, const T* R, const T& rho, const LegParameters<T>& leg, double u_sign) {
  using std::sqrt;
  const T u[3] = {leg.u[0], leg.u[1], u_sign * sqrt(T(1.0) - leg.u[0] * leg.u[0] - leg.u[1] * leg.u[1])};
  T squared(0.0);
  for (int i = 0; i < 3; ++i) {
    const T h = p[i] + R[3 * i] * leg.b[0] + R[3 * i + 1] * leg.b[1] + R[3 * i + 2] * leg.b[2] - leg.a[i] - rho * u[i];
    squared += h * h;
  }
  return leg.l - sqrt(squared);
}

/// Six-legged parallel robot with prismatic base actuators, e.g. a telescope's secondary mirror.
///
/// Configuration: x, y, z (m) added to the reference position, rx, ry, rz (rad): R = Rz Ry Rx R_reference. Rows: one a
/// leg. Parameters leg_i.{ax, ay, az, bx, by, bz, ux, uy, l}, i = 1 … 6; a in the base frame, b in the platform's.
/// Actuators leg_i.rho by inverse kinematics at nominal parameters, the lower of the two solutions.
class SixPus : public ImplicitModel {
 public:
  SixPus(const SixPusSpec& spec, const std::vector<CoordinateLimits>& pose_limits,
         std::unique_ptr<MeasurementModel> measurement);

 private:
  bool do_rows(std::span<const double> q, std::span<const double> correction, std::span<const int> selected,
               Eigen::MatrixXd& g, Eigen::Ref<Eigen::MatrixXd> g_pose,
               Eigen::Ref<Eigen::MatrixXd> g_actuators) const override;
  bool do_actuator_values(std::span<const double> q, std::span<double> values) const override;
  Eigen::Isometry3d do_tool_pose(std::span<const double> q) const override;

  SixPusSpec spec_;
  Eigen::Isometry3d X_BaseReference_;
};

}  // namespace posewright
