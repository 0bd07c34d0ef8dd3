#pragma once

#include <array>
#include <numbers>

#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/model/tip_model.hpp"
#include "posewright/problem/problem.hpp"

/// Six small displacements of a frame, D = Trans(x, y, z) Rz(rz) Ry(ry) Rx(rx), and the twists along them.
namespace posewright {

inline constexpr double degree = std::numbers::pi / 180;

inline constexpr std::array<const char*, 6> displacement_names = {"x", "y", "z", "rx", "ry", "rz"};

/// Rotation about an axis through a point; translation along an axis.
inline Twist revolute(const Eigen::Vector3d& axis, const Eigen::Vector3d& origin) {
  Twist twist;
  twist << origin.cross(axis), axis;
  return twist;
}
inline Twist prismatic(const Eigen::Vector3d& axis) {
  Twist twist;
  twist << axis, Eigen::Vector3d::Zero();
  return twist;
}

/// Axes e_u and e_v across a unit vector n: e_u along the projection of the axis that is most across n, the first of
/// equal ones; e_v = n × e_u.
inline Eigen::Matrix<double, 3, 2> axes_across(const Eigen::Vector3d& n) {
  Eigen::Index most = 0;
  n.cwiseAbs().minCoeff(&most);
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = (Eigen::Vector3d::Unit(most) - n[most] * n).normalized();
  axes.col(1) = n.cross(Eigen::Vector3d(axes.col(0)));
  return axes;
}

/// a with a · m = slope · [m, ξ] for every twist m: how slope · ξ changes if ξ is carried along m, [m, ξ] = (ω_m × v +
/// v_m × ω, ω_m × ω).
inline Twist carried_change(const Twist& twist, const Twist& slope) {
  const Eigen::Vector3d v = twist.head<3>(), w = twist.tail<3>(), a = slope.head<3>(), b = slope.tail<3>();
  Twist change;
  change << w.cross(a), v.cross(a) + w.cross(b);
  return change;
}

/// The six axes of a displacement and where they act: translations and rz along the undisplaced axes, ry and rx along
/// partially rotated ones, all through the displaced origin.
struct DisplacementAxes {
  Eigen::Matrix3d translation, rotation;  ///< columns x, y, z
  Eigen::Vector3d origin;

  /// Spatial twist along x, y, z, rx, ry, rz (0 … 5).
  Twist twist(int component) const {
    return component < 3 ? prismatic(translation.col(component)) : revolute(rotation.col(component - 3), origin);
  }
};

/// Displaces the frame by d (six values; null: zero) and returns the axes.
inline DisplacementAxes displace(Frame<double>& frame, const double* d) {
  DisplacementAxes axes;
  axes.translation = frame.R;
  axes.rotation = frame.R;
  if (d != nullptr) {
    frame.then_translate({d[0], d[1], d[2]});
    frame.then_rotate(Eigen::Vector3d::UnitZ(), d[5]);
    axes.rotation.col(1) = frame.R.col(1);
    frame.then_rotate(Eigen::Vector3d::UnitY(), d[4]);
    axes.rotation.col(0) = frame.R.col(0);
    frame.then_rotate(Eigen::Vector3d::UnitX(), d[3]);
  }
  axes.origin = frame.p;
  return axes;
}

/// Takes a displacement by d back, and returns the axes of this displacement where it begins then.
inline DisplacementAxes take_back(Frame<double>& frame, const double* d) {
  if (d != nullptr) frame.then_take_back(d);
  Frame<double> there = frame;
  return displace(there, d);
}

/// The corrections of a robot inside another one, whose own parameters are a block of `count` from `first` on. `rest`
/// holds them; empty corrections stay empty.
std::span<const double> without_block(std::span<const double> correction, int first, std::size_t count,
                                      std::vector<double>& rest);

Frame<double> frame_of(const Eigen::Isometry3d& X);
Eigen::Isometry3d isometry_of(const Frame<double>& frame);

/// Spatial twists expressed in A, given in B: adjoint of X_AB.
void change_frame(const Eigen::Isometry3d& X_AB, Eigen::Ref<Twists> twists);

/// The k-th of a pose's coordinates x, y, z (m), then three angles (rad): within ±reach, or the problem's limits.
Coordinate pose_coordinate(const std::string& name, std::size_t k, double reach,
                           const std::vector<CoordinateLimits>& limits);

/// Parameters NAME.{x,y,z,rx,ry,rz} of a frame at X.
void append_displacement(std::vector<Parameter>& parameters, const std::string& name, const Eigen::Isometry3d& X,
                         double length_tolerance, double angle_tolerance);

}  // namespace posewright
