#include "posewright/model/delta.hpp"

#include <array>
#include <numbers>

namespace posewright {
namespace {

constexpr int delta_legs = 3, delta_parameters = 6;
constexpr double delta_length_tolerance = 0.5e-3, delta_angle_tolerance = 1e-3;  // m, rad
constexpr std::array<const char*, delta_parameters> delta_names = {"base_radius", "platform_radius", "arm",
                                                                   "forearm",     "offset",          "azimuth"};

using DeltaLeg = std::array<double, delta_parameters>;

DeltaLeg nominal_leg(const DeltaSpec& spec, int i) {
  return {spec.base_radius, spec.platform_radius, spec.arm, spec.forearm, 0.0, i * 2 * std::numbers::pi / 3};
}

DeltaLeg corrected_leg(const DeltaSpec& spec, int i, std::span<const double> own) {
  DeltaLeg leg = nominal_leg(spec, i);
  if (!own.empty())
    for (std::size_t k = 0; k < delta_parameters; ++k) leg[k] += own[std::size_t(delta_parameters * i) + k];
  return leg;
}

}  // namespace

Delta::Delta(const DeltaSpec& spec) : ClosedChain(spec.placement), spec_(spec) {
  std::vector<Parameter> own;
  for (int i = 0; i < delta_legs; ++i) {
    const std::string prefix = "leg_" + std::to_string(i + 1) + ".";
    const DeltaLeg nominal = nominal_leg(spec, i);
    for (std::size_t k = 0; k < delta_parameters; ++k)
      own.push_back({prefix + delta_names[k], k < 4 ? "m" : "rad", nominal[k],
                     k < 4 ? delta_length_tolerance : delta_angle_tolerance, Role::interest});
    actuators_.push_back({prefix + "rho", "rad", spec.travel_lower, spec.travel_upper});
  }
  for (int k = 0; k < 3; ++k) coordinates_.push_back({std::string(1, "xyz"[k]), "m", spec.lower[k], spec.upper[k]});
  finish(own, spec.encoder_noise);
}

Eigen::Isometry3d Delta::do_platform(std::span<const double> q, Twists& freedoms) const {
  freedoms = Twists::Identity(6, 3);
  return Eigen::Isometry3d(Eigen::Translation3d(q[0], q[1], q[2]));
}

bool Delta::do_inverse_kinematics(std::span<const double> q, std::span<const double> own, std::span<double> rho) const {
  for (int i = 0; i < delta_legs; ++i) {
    const DeltaLeg leg = corrected_leg(spec_, i, own);
    const Eigen::Vector3d d(std::cos(leg[5]), std::sin(leg[5]), 0);
    // From the arm's pivot to the platform's joint; A cos θ + B sin θ = K closes the loop.
    const Eigen::Vector3d c = Eigen::Vector3d(q[0], q[1], q[2]) + (leg[1] - leg[0]) * d;
    const double A = c.dot(d), B = -c.z();
    const double cosine = (c.squaredNorm() + leg[2] * leg[2] - leg[3] * leg[3]) / (2 * leg[2] * std::hypot(A, B));
    if (!(std::abs(cosine) < 1)) return false;
    // Of the two solutions the elbow that points outwards, whether the platform hangs or stands.
    rho[std::size_t(i)] =
        std::remainder(std::atan2(B, A) - std::copysign(std::acos(cosine), B) - leg[4], 2 * std::numbers::pi);
  }
  return true;
}

std::vector<Polyline> Delta::do_skeleton(std::span<const double> q, std::span<const double> rho) const {
  const Eigen::Vector3d centre(q[0], q[1], q[2]);
  std::vector<Polyline> lines;
  Polyline base, platform;
  for (int i = 0; i < delta_legs; ++i) {
    const DeltaLeg leg = nominal_leg(spec_, i);
    const Eigen::Vector3d d(std::cos(leg[5]), std::sin(leg[5]), 0);
    const double theta = rho[std::size_t(i)];
    base.emplace_back(leg[0] * d);
    platform.emplace_back(centre + leg[1] * d);
    const Eigen::Vector3d elbow =
        base.back() + leg[2] * (std::cos(theta) * d - std::sin(theta) * Eigen::Vector3d::UnitZ());
    lines.push_back({base.back(), elbow, platform.back()});
  }
  for (Polyline* rim : {&base, &platform}) {
    rim->push_back(rim->front());
    lines.push_back(std::move(*rim));
  }
  return lines;
}

void Delta::do_loops(const LoopState& at, Loops& out) const {
  const auto& [q, rho, own, selected] = at;
  for (int i = 0; i < delta_legs; ++i) {
    const DeltaLeg leg = corrected_leg(spec_, i, own);
    const double theta = rho[std::size_t(i)] + leg[4], cosine = std::cos(theta), sine = std::sin(theta);
    const Eigen::Vector3d d(std::cos(leg[5]), std::sin(leg[5]), 0), across(-d.y(), d.x(), 0);
    const double radial = leg[1] - leg[0] - leg[2] * cosine;
    const Eigen::Vector3d h = Eigen::Vector3d(q[0], q[1], q[2]) + radial * d + Eigen::Vector3d(0, 0, leg[2] * sine);
    const Eigen::Vector3d e = h.normalized();
    out.value[i] = leg[3] - h.norm();
    const double swing = -leg[2] * (sine * e.dot(d) + cosine * e.z());
    const DeltaLeg columns = {e.dot(d), -e.dot(d), cosine * e.dot(d) - sine * e.z(),
                              1.0,      swing,     -radial * e.dot(across)};
    for (std::size_t c = 0; c < selected.size(); ++c)
      if (selected[c] >= 0 && selected[c] / delta_parameters == i)
        out.parameter(i, Eigen::Index(c)) = columns[std::size_t(selected[c] % delta_parameters)];
    out.platform.row(i).head<3>() = -e.transpose();
    out.actuator(i, i) = swing;
  }
}

bool Delta::do_loops_change(const LoopState& at, const Loops& slope, Twist& by_platform,
                            Eigen::VectorXd& by_actuators) const {
  const auto& [q, rho, own, selected] = at;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (int i = 0; i < delta_legs; ++i) {
    const DeltaLeg leg = corrected_leg(spec_, i, own);
    const double theta = rho[std::size_t(i)] + leg[4], cosine = std::cos(theta), sine = std::sin(theta);
    const Eigen::Vector3d d(std::cos(leg[5]), std::sin(leg[5]), 0), across(-d.y(), d.x(), 0);
    const double radial = leg[1] - leg[0] - leg[2] * cosine;
    const Eigen::Vector3d h = Eigen::Vector3d(q[0], q[1], q[2]) + radial * d + leg[2] * sine * up;
    const double reach = h.norm();
    const Eigen::Vector3d e = h / reach;
    DeltaLeg a{};  // slopes of this leg's columns, see do_loops()
    for (std::size_t c = 0; c < selected.size(); ++c)
      if (selected[c] >= 0 && selected[c] / delta_parameters == i)
        a[std::size_t(selected[c] % delta_parameters)] += slope.parameter(i, Eigen::Index(c));
    const double swing = -leg[2] * (a[4] + slope.actuator(i, i));
    const Eigen::Vector3d by_e = (a[0] - a[1]) * d + a[2] * (cosine * d - sine * up) +
                                 swing * (sine * d + cosine * up) - a[5] * radial * across -
                                 slope.platform.row(i).head<3>().transpose();
    const Eigen::Vector3d by_h = (by_e - e.dot(by_e) * e) / reach;
    by_platform.head<3>() += by_h;
    by_actuators[i] += swing * (cosine * e.dot(d) - sine * e.z()) - a[2] * (sine * e.dot(d) + cosine * e.z()) -
                       a[5] * leg[2] * sine * e.dot(across) + leg[2] * by_h.dot(sine * d + cosine * up);
  }
  return true;
}

}  // namespace posewright
