#include "posewright/model/six_pus.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "posewright/model/placement.hpp"

namespace posewright {
namespace {

constexpr int legs = 6;
constexpr int leg_parameters = 9;
constexpr double default_length_tolerance = 0.5e-3;   // m
constexpr double default_direction_tolerance = 1e-3;  // rad, as components of a unit vector

/// Actuator position that gives the leg its length: ‖q − ρu‖ = l, q = p + R b − a.
bool inverse_kinematics(const LegSpec& leg, const Eigen::Isometry3d& X, double& rho) {
  const Eigen::Vector3d q = X * leg.b - leg.a;
  const double along = leg.u.dot(q);
  const double under_root = along * along - (q.squaredNorm() - leg.l * leg.l);
  if (!(under_root > 0)) return false;
  rho = along - std::sqrt(under_root);
  return true;
}

/// One leg with its corrections applied, and what its column entries are made of.
struct Leg {
  Eigen::Vector3d a, b, u;
  double uz_x, uz_y;  ///< ∂uz/∂ux, ∂uz/∂uy

  Leg(const LegSpec& spec, std::span<const double> correction) : a(spec.a), b(spec.b), u(spec.u) {
    if (!correction.empty()) {
      a += Eigen::Vector3d(correction[0], correction[1], correction[2]);
      b += Eigen::Vector3d(correction[3], correction[4], correction[5]);
      const double ux = u.x() + correction[6], uy = u.y() + correction[7];
      u = {ux, uy, std::copysign(std::sqrt(std::max(0.0, 1 - ux * ux - uy * uy)), u.z())};
    }
    uz_x = -u.x() / u.z();
    uz_y = -u.y() / u.z();
  }
};

/// ∂g/∂ξ for one leg parameter; e is the unit vector along the leg.
double column_entry(int parameter, const Leg& leg, const Eigen::Vector3d& e, const Eigen::Vector3d& e_platform,
                    double rho) {
  if (parameter < 3) return e[parameter];
  if (parameter < 6) return -e_platform[parameter - 3];
  if (parameter == 6) return rho * (e.x() + e.z() * leg.uz_x);
  if (parameter == 7) return rho * (e.y() + e.z() * leg.uz_y);
  return 1.0;
}

}  // namespace

SixPus::SixPus(const SixPusSpec& spec, const std::vector<CoordinateLimits>& pose_limits,
               std::unique_ptr<MeasurementModel> measurement)
    : ImplicitModel(std::move(measurement), spec.actuator_noise), spec_(spec) {
  X_BaseReference_ = isometry(spec.reference);
  rows_ = legs;
  static constexpr std::array<const char*, leg_parameters> names = {"ax", "ay", "az", "bx", "by",
                                                                    "bz", "ux", "uy", "l"};
  for (int i = 0; i < legs; ++i) {
    const LegSpec& leg = spec_.legs[std::size_t(i)];
    const std::string prefix = "leg_" + std::to_string(i + 1) + ".";
    const std::array<double, leg_parameters> nominal = {leg.a.x(), leg.a.y(), leg.a.z(), leg.b.x(), leg.b.y(),
                                                        leg.b.z(), leg.u.x(), leg.u.y(), leg.l};
    for (int k = 0; k < leg_parameters; ++k) {
      const bool direction = k == 6 || k == 7;
      geometric_.push_back({int(parameters_.size()), 0});
      parameters_.push_back({prefix + names[std::size_t(k)], direction ? "1" : "m", nominal[std::size_t(k)],
                             direction ? default_direction_tolerance : default_length_tolerance, Role::interest});
    }
    actuators_.push_back({prefix + "rho", "m", spec_.travel_lower, spec_.travel_upper});
  }
  static constexpr std::array<const char*, 6> coordinate_names = {"x", "y", "z", "rx", "ry", "rz"};
  for (std::size_t k = 0; k < 6; ++k) {
    // Without limits from the problem file, a platform moves as far as its actuators let it: anything larger serves.
    const double reach = k < 3 ? spec_.legs.front().l : std::numbers::pi / 2;
    coordinates_.push_back({coordinate_names[k], k < 3 ? "m" : "rad", -reach, reach});
    for (const CoordinateLimits& limits : pose_limits)
      if (limits.name.value == coordinate_names[k]) {
        coordinates_.back().lower = limits.lower;
        coordinates_.back().upper = limits.upper;
      }
  }
}

Eigen::Isometry3d SixPus::do_tool_pose(std::span<const double> q) const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = rotation_of_rpy({q[3], q[4], q[5]}) * X_BaseReference_.linear();
  X.translation() = X_BaseReference_.translation() + Eigen::Vector3d(q[0], q[1], q[2]);
  return X;
}

bool SixPus::do_actuator_values(std::span<const double> q, std::span<double> values) const {
  const Eigen::Isometry3d X = do_tool_pose(q);
  for (std::size_t i = 0; i < legs; ++i)
    if (!inverse_kinematics(spec_.legs[i], X, values[i])) return false;
  return true;
}

bool SixPus::do_rows(std::span<const double> q, std::span<const double> correction, std::span<const int> selected,
                     Eigen::MatrixXd& g, Eigen::Ref<Eigen::MatrixXd> g_pose,
                     Eigen::Ref<Eigen::MatrixXd> g_actuators) const {
  const Eigen::Isometry3d X = do_tool_pose(q);
  g.setZero();
  g_actuators.setZero();
  for (int i = 0; i < legs; ++i) {
    double rho = 0;
    if (!inverse_kinematics(spec_.legs[std::size_t(i)], X, rho)) return false;
    const Leg leg(
        spec_.legs[std::size_t(i)],
        correction.empty() ? correction : correction.subspan(std::size_t(i * leg_parameters), leg_parameters));
    const Eigen::Vector3d joint = X * leg.b;
    const Eigen::Vector3d e = (joint - leg.a - rho * leg.u).normalized();
    const Eigen::Vector3d e_platform = X.linear().transpose() * e;
    for (std::size_t c = 0; c < selected.size(); ++c)
      if (selected[c] / leg_parameters == i)
        g(i, Eigen::Index(c)) = column_entry(selected[c] % leg_parameters, leg, e, e_platform, rho);
    // A twist (v, ω) moves the platform joint by v + ω × joint.
    g_pose.row(i) << -e.transpose(), -joint.cross(e).transpose();
    g_actuators(i, i) = leg.u.dot(e);
  }
  return true;
}

}  // namespace posewright
