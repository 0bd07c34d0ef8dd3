#pragma once

#include <cmath>

#include "posewright/model/dh_chain.hpp"
#include "posewright/model/serial_chain_kinematics.hpp"

/// The equations of robots in any scalar, as their papers write them: what the derivatives of models are tested
/// against.
namespace posewright {

/// Pose of the tip in the measurement frame:
///   X_MeasureBase D(base) · Π_k [X_ParentJoint,k D_k Motion_k(multiplier ((1 + gear) q + offset) + mimic offset)] ·
///   X_LastTip D(tool),
/// with X_ParentJoint,k Motion_k D_k⁻¹ for a joint that is passed backward.
/// @param correction  all parameters in the order of ChainLayout
template <class T>
Frame<T> tip_pose(const ChainDescription& chain, const ChainLayout& layout, const double* q, const T* correction) {
  Frame<T> frame;
  frame.then(chain.X_MeasureBase);
  frame.then_displace(correction);
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    const ChainJoint& joint = chain.joints[k];
    const T* d = correction + layout.displacement[k];
    frame.then(joint.X_ParentJoint);
    if (!joint.backward()) frame.then_displace(d);
    const T* own = correction + layout.offset[std::size_t(joint.coordinate)];
    const T value = joint.multiplier * ((T(1.0) + own[1]) * q[joint.coordinate] + own[0]) + T(joint.offset);
    if (joint.prismatic) frame.then_translate(joint.axis.cast<T>() * value);
    else frame.then_rotate(joint.axis, value);
    if (!joint.backward()) continue;
    for (int axis = 0; axis < 3; ++axis) frame.then_rotate(Eigen::Vector3d::Unit(axis), -d[3 + axis]);
    frame.then_translate({-d[0], -d[1], -d[2]});
  }
  frame.then(chain.X_LastTip);
  frame.then_displace(correction + layout.tool);
  return frame;
}

/// Pose of the tip in a scalar of its own, for differentiation; corrections: base (6), motions with a name, tool (6).
template <class T>
Frame<T> dh_tip_pose(const DhDescription& chain, const double* q, const T* correction) {
  Frame<T> frame;
  frame.then(chain.base);
  frame.then_displace(correction);
  const T* next = correction + 6;
  for (const ElementaryMotion& motion : chain.motions) {
    T value = T(motion.nominal);
    if (motion.coordinate >= 0) value += T(q[motion.coordinate]);
    if (!motion.name.empty()) value += *next++;
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(motion.axis);
    if (motion.rotation) frame.then_rotate(axis, value);
    else frame.then_translate(axis.cast<T>() * value);
  }
  frame.then(chain.tool);
  frame.then_displace(next);
  return frame;
}

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

/// One leg's parameters in the scalar type T: base joint a, platform joint b, actuator direction u, length l.
template <class T>
struct LegParameters {
  T a[3], b[3], u[2], l;  ///< u without its third component, which is √(1 − ux² − uy²) with the nominal sign
};

/// Loop equation of one leg, g = l + extension − ‖p + R (b + lift·z) − a − slide·u‖ (theory.md eq. (8)). A leg with a
/// prismatic base joint slides, a leg of variable length extends; `lift` is the platform's deformation at b.
/// @param p, R    platform pose in the base frame (m; row-major rotation)
/// @param u_sign  sign of the third component of u
template <class T>
T leg_residual(const T* p, const T* R, const T& slide, const T& extension, const T& lift, const LegParameters<T>& leg,
               double u_sign) {
  using std::sqrt;
  const T u[3] = {leg.u[0], leg.u[1], u_sign * sqrt(T(1.0) - leg.u[0] * leg.u[0] - leg.u[1] * leg.u[1])};
  T squared(0.0);
  for (int i = 0; i < 3; ++i) {
    const T h = p[i] + R[3 * i] * leg.b[0] + R[3 * i + 1] * leg.b[1] + R[3 * i + 2] * (leg.b[2] + lift) - leg.a[i] -
                slide * u[i];
    squared += h * h;
  }
  return leg.l + extension - sqrt(squared);
}

}  // namespace posewright
