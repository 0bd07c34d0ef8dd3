#include "posewright/model/five_bar.hpp"

#include <array>
#include <numbers>

namespace posewright {
namespace {

constexpr int five_bar_parameters = 6;
constexpr double five_bar_length_tolerance = 0.5e-3, five_bar_angle_tolerance = 1e-3;  // m, rad
constexpr std::array<const char*, five_bar_parameters> five_bar_names = {"ax",     "ay",     "proximal",
                                                                         "distal", "offset", "sensor_offset"};

/// One leg at one configuration, corrections applied.
struct FiveBarLeg {
  Eigen::Vector2d base, along, across;  ///< base joint; unit vectors of the proximal link
  Eigen::Vector2d e;                    ///< unit vector of the distal link
  double proximal, distal, reach;       ///< reach: distance from elbow to point
};

double five_bar_part(std::span<const double> own, int leg, int k) {
  return own.empty() ? 0.0 : own[std::size_t(five_bar_parameters * leg + k)];
}

FiveBarLeg leg_at(const FiveBarSpec& spec, int i, std::span<const double> q, double rho, std::span<const double> own) {
  const FiveBarSpec::Leg& nominal = spec.legs[std::size_t(i)];
  FiveBarLeg leg;
  leg.base = nominal.base + Eigen::Vector2d(five_bar_part(own, i, 0), five_bar_part(own, i, 1));
  leg.proximal = nominal.proximal + five_bar_part(own, i, 2);
  leg.distal = nominal.distal + five_bar_part(own, i, 3);
  const double angle = rho + five_bar_part(own, i, 4);
  leg.along = {std::cos(angle), std::sin(angle)};
  leg.across = {-leg.along.y(), leg.along.x()};
  const Eigen::Vector2d d = Eigen::Vector2d(q[0], q[1]) - leg.base - leg.proximal * leg.along;
  leg.reach = d.norm();
  leg.e = d / leg.reach;
  return leg;
}

}  // namespace

FiveBar::FiveBar(const FiveBarSpec& spec) : ClosedChain(spec.placement), spec_(spec) {
  std::vector<Parameter> own;
  for (int i = 0; i < 2; ++i) {
    const FiveBarSpec::Leg& leg = spec.legs[std::size_t(i)];
    const std::string prefix = "leg_" + std::to_string(i + 1) + ".";
    const std::array<double, five_bar_parameters> nominal = {
        leg.base.x(), leg.base.y(), leg.proximal, leg.distal, 0, 0};
    for (int k = 0; k < five_bar_parameters; ++k)
      own.push_back({prefix + five_bar_names[std::size_t(k)], k < 4 ? "m" : "rad", nominal[std::size_t(k)],
                     k < 4 ? five_bar_length_tolerance : five_bar_angle_tolerance, Role::interest});
    actuators_.push_back({prefix + "rho", "rad", -std::numbers::pi, std::numbers::pi});
    sensors_.push_back({prefix + "elbow", "rad", -std::numbers::pi, std::numbers::pi});
  }
  coordinates_ = {{"x", "m", spec.x_lower, spec.x_upper}, {"y", "m", spec.y_lower, spec.y_upper}};
  finish(own, spec.encoder_noise);
}

Eigen::Isometry3d FiveBar::do_platform(std::span<const double> q, Twists& freedoms) const {
  freedoms = Twists::Identity(6, 2);
  return Eigen::Isometry3d(Eigen::Translation3d(q[0], q[1], 0));
}

bool FiveBar::do_inverse_kinematics(std::span<const double> q, std::span<const double> own,
                                    std::span<double> rho) const {
  for (int i = 0; i < 2; ++i) {
    const FiveBarSpec::Leg& nominal = spec_.legs[std::size_t(i)];
    const Eigen::Vector2d to_point = Eigen::Vector2d(q[0], q[1]) - nominal.base -
                                     Eigen::Vector2d(five_bar_part(own, i, 0), five_bar_part(own, i, 1));
    const double proximal = nominal.proximal + five_bar_part(own, i, 2),
                 distal = nominal.distal + five_bar_part(own, i, 3);
    const double d = to_point.norm();
    const double cosine = (d * d + proximal * proximal - distal * distal) / (2 * d * proximal);
    if (!(std::abs(cosine) < 1)) return false;
    const double angle = std::atan2(to_point.y(), to_point.x()) + nominal.elbow * std::acos(cosine);
    rho[std::size_t(i)] = std::remainder(angle - five_bar_part(own, i, 4), 2 * std::numbers::pi);
  }
  return true;
}

std::vector<Polyline> FiveBar::do_skeleton(std::span<const double> q, std::span<const double> rho) const {
  const auto lifted = [](const Eigen::Vector2d& p) { return Eigen::Vector3d(p.x(), p.y(), 0); };
  std::vector<Polyline> lines;
  for (int i = 0; i < 2; ++i) {
    const FiveBarLeg leg = leg_at(spec_, i, q, rho[std::size_t(i)], {});
    lines.push_back({lifted(leg.base), lifted(leg.base + leg.proximal * leg.along), {q[0], q[1], 0}});
  }
  lines.push_back({lines[0].front(), lines[1].front()});
  return lines;
}

void FiveBar::do_loops(const LoopState& at, Loops& out) const {
  const auto& [q, rho, own, selected] = at;
  for (int i = 0; i < 2; ++i) {
    const FiveBarLeg leg = leg_at(spec_, i, q, rho[std::size_t(i)], own);
    out.value[i] = leg.distal - leg.reach;
    const double swing = leg.proximal * leg.e.dot(leg.across);
    const std::array<double, five_bar_parameters> columns = {leg.e.x(), leg.e.y(), leg.e.dot(leg.along),
                                                             1.0,       swing,     0.0};
    for (std::size_t c = 0; c < selected.size(); ++c)
      if (selected[c] >= 0 && selected[c] / five_bar_parameters == i)
        out.parameter(i, Eigen::Index(c)) = columns[std::size_t(selected[c] % five_bar_parameters)];
    out.platform.row(i).head<2>() = -leg.e.transpose();
    out.actuator(i, i) = swing;
  }
}

void FiveBar::do_sensors(const LoopState& at, Loops& out) const {
  const auto& [q, rho, own, selected] = at;
  for (int i = 0; i < 2; ++i) {
    const FiveBarLeg leg = leg_at(spec_, i, q, rho[std::size_t(i)], own);
    // The distal link's direction turns by n·δ/reach when its ends move by δ apart.
    const Eigen::Vector2d n = Eigen::Vector2d(-leg.e.y(), leg.e.x()) / leg.reach;
    // Distal against proximal link, less the sensor's own zero.
    out.value[i] = std::remainder(
        std::atan2(leg.e.y(), leg.e.x()) - std::atan2(leg.along.y(), leg.along.x()) - five_bar_part(own, i, 5),
        2 * std::numbers::pi);
    const double swing = -leg.proximal * n.dot(leg.across) - 1.0;
    const std::array<double, five_bar_parameters> columns = {-n.x(), -n.y(), -n.dot(leg.along), 0.0, swing, -1.0};
    for (std::size_t c = 0; c < selected.size(); ++c)
      if (selected[c] >= 0 && selected[c] / five_bar_parameters == i)
        out.parameter(i, Eigen::Index(c)) = columns[std::size_t(selected[c] % five_bar_parameters)];
    out.platform.row(i).head<2>() = n.transpose();
    out.actuator(i, i) = swing;
  }
}

bool FiveBar::do_loops_change(const LoopState& at, const Loops& slope, Twist& by_platform,
                              Eigen::VectorXd& by_actuators) const {
  const auto& [q, rho, own, selected] = at;
  for (int i = 0; i < 2; ++i) {
    const FiveBarLeg leg = leg_at(spec_, i, q, rho[std::size_t(i)], own);
    std::array<double, five_bar_parameters> a{};  // slopes of this leg's columns, see do_loops()
    for (std::size_t c = 0; c < selected.size(); ++c)
      if (selected[c] >= 0 && selected[c] / five_bar_parameters == i)
        a[std::size_t(selected[c] % five_bar_parameters)] += slope.parameter(i, Eigen::Index(c));
    const double swing = leg.proximal * (a[4] + slope.actuator(i, i));
    const Eigen::Vector2d by_e = Eigen::Vector2d(a[0], a[1]) + a[2] * leg.along + swing * leg.across -
                                 slope.platform.row(i).head<2>().transpose();
    const Eigen::Vector2d by_d = (by_e - leg.e.dot(by_e) * leg.e) / leg.reach;
    by_platform.head<2>() += by_d;
    by_actuators[i] +=
        a[2] * leg.e.dot(leg.across) - swing * leg.e.dot(leg.along) - leg.proximal * by_d.dot(leg.across);
  }
  return true;
}

}  // namespace posewright
