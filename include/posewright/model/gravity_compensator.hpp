#pragma once

#include <cmath>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Linkage of a gravity compensator at joint position q2 (theory.md eq. (12)): a = |P0P2|, γ = α − q2 with α =
/// atan2(ax, ay), s = |P0P1| = √(a² + L² + 2 a L cos γ). Both results are linear in the spring's stiffness Kc (N/m) and
/// its preload s0·Kc (N).
template <class T>
struct CompensatorLinkage {
  T aL, sine, cosine, s;

  CompensatorLinkage(const CompensatorSpec& spec, const T& q2) {
    using std::cos, std::sin, std::sqrt;
    const double a = std::hypot(spec.ax, spec.ay);
    const T gamma = std::atan2(spec.ax, spec.ay) - q2;
    aL = T(a * spec.L);
    sine = sin(gamma);
    cosine = cos(gamma);
    s = sqrt(T(a * a + spec.L * spec.L) + 2.0 * aL * cosine);
  }

  /// Torque on the joint (N·m): M = Kc (1 − s0/s) a L sin γ.
  T torque(const T& stiffness, const T& preload) const { return (stiffness - preload / s) * aL * sine; }

  /// Its derivative by q2, the spring's part of the joint's stiffness (N·m/rad):
  ///   −Kc a L cos γ + Kc s0 (a L/s) (cos γ + (a L/s²) sin² γ).
  T added_stiffness(const T& stiffness, const T& preload) const {
    return preload * (aL / s) * (cosine + aL / (s * s) * sine * sine) - stiffness * aL * cosine;
  }
};

}  // namespace posewright
