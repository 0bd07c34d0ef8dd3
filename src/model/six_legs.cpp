#include "posewright/model/six_legs.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "displacement.hpp"
#include "posewright/model/placement.hpp"

namespace posewright {
namespace {

constexpr int leg_count = 6;
constexpr double default_length_tolerance = 0.5e-3;     // m
constexpr double default_direction_tolerance = 1e-3;    // rad, as components of a unit vector
constexpr double default_deformation_tolerance = 0.01;  // m of platform per m of actuator

// The deformation contracts the fixed point of inverse kinematics by about its own size, so this is far more than
// enough.
constexpr int most_iterations = 200;

enum Entry { ax, ay, az, bx, by, bz, ux, uy, length };

/// What the columns of leg parameters mean, in the order of the catalogue.
constexpr std::array<Entry, 9> slide_entries = {ax, ay, az, bx, by, bz, ux, uy, length};
constexpr std::array<Entry, 7> extend_entries = {ax, ay, az, bx, by, bz, length};
constexpr std::array<const char*, 9> entry_names = {"ax", "ay", "az", "bx", "by", "bz", "ux", "uy", "l"};

/// One leg with its corrections applied.
struct PlacedLeg {
  Eigen::Vector3d a, b, u;
  double l;

  PlacedLeg(const LegSpec& spec, std::span<const Entry> entries, std::span<const double> correction)
      : a(spec.a), b(spec.b), u(spec.u), l(spec.l) {
    for (std::size_t k = 0; k < correction.size(); ++k) {
      const Entry entry = entries[k];
      if (entry <= az) a[entry] += correction[k];
      else if (entry <= bz) b[entry - bx] += correction[k];
      else if (entry <= uy) u[entry - ux] += correction[k];
      else l += correction[k];
    }
    if (!correction.empty())
      u.z() = std::copysign(std::sqrt(std::max(0.0, 1 - u.x() * u.x() - u.y() * u.y())), spec.u.z());
  }
};

/// Deformation of the platform: lift of leg i's joint by the actuators.
struct Deformation {
  double kappa = 0.0;
  std::array<double, 36> K{};
  bool none = true;

  explicit Deformation(std::span<const double> correction) {
    if (correction.empty()) return;
    kappa = correction[0];
    std::copy_n(correction.begin() + 1, 36, K.begin());
    none = std::all_of(correction.begin(), correction.end(), [](double x) { return x == 0; });
  }
  double lift(int leg, std::span<const double> rho) const {
    double sum = kappa * rho[std::size_t(leg)];
    for (int j = 0; j < leg_count; ++j) sum += K[std::size_t(6 * leg + j)] * rho[std::size_t(j)];
    return sum;
  }
};

/// Slide that gives the leg its length: ‖q − ρu‖ = l, q = p + R b − a.
bool slide_of(const PlacedLeg& leg, const Eigen::Vector3d& joint, double& rho) {
  const Eigen::Vector3d q = joint - leg.a;
  const double along = leg.u.dot(q);
  const double under_root = along * along - (q.squaredNorm() - leg.l * leg.l);
  if (!(under_root > 0)) return false;
  rho = along - std::sqrt(under_root);
  return true;
}

std::span<const Entry> entries_of(LegActuation actuation) {
  if (actuation == LegActuation::slide) return slide_entries;
  return extend_entries;
}

std::span<const double> leg_part(std::span<const double> own, int leg, int per_leg) {
  return own.empty() ? own : own.subspan(std::size_t(leg * per_leg), std::size_t(per_leg));
}

std::vector<Parameter> catalogue(const SixLegsSpec& spec) {
  std::vector<Parameter> parameters;
  for (int i = 0; i < leg_count; ++i) {
    const LegSpec& leg = spec.legs[std::size_t(i)];
    const std::array<double, 9> nominal = {leg.a.x(), leg.a.y(), leg.a.z(), leg.b.x(), leg.b.y(),
                                           leg.b.z(), leg.u.x(), leg.u.y(), leg.l};
    for (const Entry entry : entries_of(spec.actuation)) {
      const bool direction = entry == ux || entry == uy;
      parameters.push_back({"leg_" + std::to_string(i + 1) + "." + entry_names[entry], direction ? "1" : "m",
                            nominal[entry], direction ? default_direction_tolerance : default_length_tolerance,
                            Role::interest});
    }
  }
  if (spec.actuation == LegActuation::extend) return parameters;
  parameters.push_back({"kappa", "1", 0.0, default_deformation_tolerance, Role::interest});
  for (int i = 1; i <= leg_count; ++i)
    for (int j = 1; j <= leg_count; ++j)
      parameters.push_back(
          {"K_" + std::to_string(i) + std::to_string(j), "1", 0.0, default_deformation_tolerance, Role::interest});
  return parameters;
}

}  // namespace

SixLegs::SixLegs(const SixLegsSpec& spec, const std::vector<CoordinateLimits>& pose_limits)
    : ClosedChain(spec.placement),
      spec_(spec),
      X_BaseReference_(isometry(spec.reference)),
      per_leg_(int(entries_of(spec.actuation).size())) {
  for (int i = 0; i < leg_count; ++i)
    actuators_.push_back({"leg_" + std::to_string(i + 1) + ".rho", "m", spec.travel_lower, spec.travel_upper});
  for (std::size_t k = 0; k < 6; ++k) {
    // Without limits from the problem file, a platform moves as far as its actuators let it: anything larger serves.
    const double reach = k < 3 ? spec.legs.front().l + spec.travel_upper : std::numbers::pi / 2;
    coordinates_.push_back({displacement_names[k], k < 3 ? "m" : "rad", -reach, reach});
    for (const CoordinateLimits& limits : pose_limits)
      if (limits.name.value == displacement_names[k]) {
        coordinates_.back().lower = limits.lower;
        coordinates_.back().upper = limits.upper;
      }
  }
  finish(catalogue(spec), spec.actuator_noise);
  // A deforming platform is a model of its own, not a part of the geometry that `auto` chooses from.
  std::erase_if(geometric_, [&](const IdentificationModel::Preference& p) {
    const std::string& name = parameters_[std::size_t(p.parameter)].name;
    return name == "kappa" || name.starts_with("K_");
  });
}

Eigen::Isometry3d SixLegs::platform_pose(std::span<const double> q) const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = rotation_of_rpy({q[3], q[4], q[5]}) * X_BaseReference_.linear();
  X.translation() = X_BaseReference_.translation() + Eigen::Vector3d(q[0], q[1], q[2]);
  return X;
}

Eigen::Isometry3d SixLegs::do_platform(std::span<const double> q, Twists& freedoms) const {
  const Eigen::Isometry3d X = platform_pose(q);
  freedoms.resize(6, 6);
  for (int k = 0; k < 3; ++k) freedoms.col(k) = prismatic(Eigen::Vector3d::Unit(k));
  const Eigen::Matrix3d yaw = rotation_of_rpy({0, 0, q[5]}), yaw_pitch = rotation_of_rpy({0, q[4], q[5]});
  freedoms.col(3) = revolute(yaw_pitch.col(0), X.translation());
  freedoms.col(4) = revolute(yaw.col(1), X.translation());
  freedoms.col(5) = revolute(Eigen::Vector3d::UnitZ(), X.translation());
  return X;
}

bool SixLegs::do_inverse_kinematics(std::span<const double> q, std::span<const double> own,
                                    std::span<double> rho) const {
  const Eigen::Isometry3d X = platform_pose(q);
  const auto entries = entries_of(spec_.actuation);
  const bool slides = spec_.actuation == LegActuation::slide;
  const Deformation deformation(slides && !own.empty() ? own.subspan(std::size_t(leg_count * per_leg_)) : own.first(0));
  std::array<double, 6> lift{}, before{};
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    for (int i = 0; i < leg_count; ++i) {
      const auto k = std::size_t(i);
      const PlacedLeg leg(spec_.legs[k], entries, leg_part(own, i, per_leg_));
      const Eigen::Vector3d joint = X * Eigen::Vector3d(leg.b + lift[k] * Eigen::Vector3d::UnitZ());
      if (!slides) rho[k] = (joint - leg.a).norm() - leg.l;
      else if (!slide_of(leg, joint, rho[k])) return false;
    }
    if (deformation.none || std::equal(rho.begin(), rho.end(), before.begin())) return true;
    std::copy(rho.begin(), rho.end(), before.begin());
    for (int i = 0; i < leg_count; ++i) lift[std::size_t(i)] = deformation.lift(i, rho);
  }
  return true;  // alternates between neighbouring doubles
}

std::vector<Polyline> SixLegs::do_skeleton(std::span<const double> q, std::span<const double> rho) const {
  const Eigen::Isometry3d X = platform_pose(q);
  std::vector<Polyline> lines;
  Polyline base, platform;
  for (std::size_t i = 0; i < leg_count; ++i) {
    const LegSpec& leg = spec_.legs[i];
    const Eigen::Vector3d joint = X * leg.b;
    if (spec_.actuation == LegActuation::slide) lines.push_back({leg.a, leg.a + rho[i] * leg.u, joint});
    else lines.push_back({leg.a, joint});
    base.push_back(leg.a);
    platform.push_back(joint);
  }
  for (Polyline* rim : {&base, &platform}) {
    rim->push_back(rim->front());
    lines.push_back(std::move(*rim));
  }
  return lines;
}

void SixLegs::do_loops(std::span<const double> q, std::span<const double> rho, std::span<const double> own,
                       std::span<const int> selected, Loops& out) const {
  const Eigen::Isometry3d X = platform_pose(q);
  const auto entries = entries_of(spec_.actuation);
  const bool slides = spec_.actuation == LegActuation::slide;
  const int first_deformation = leg_count * per_leg_;
  const Deformation deformation(slides && !own.empty() ? own.subspan(std::size_t(first_deformation)) : own.first(0));
  for (int i = 0; i < leg_count; ++i) {
    const double slide = slides ? rho[std::size_t(i)] : 0.0, extension = slides ? 0.0 : rho[std::size_t(i)];
    const PlacedLeg leg(spec_.legs[std::size_t(i)], entries, leg_part(own, i, per_leg_));
    const double lift = deformation.none ? 0.0 : deformation.lift(i, rho);
    const Eigen::Vector3d joint = X * Eigen::Vector3d(leg.b + lift * Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d h = joint - leg.a - slide * leg.u, e = h.normalized();
    const Eigen::Vector3d e_platform = X.linear().transpose() * e;
    out.value[i] = leg.l + extension - h.norm();
    const auto column_entry = [&](Entry entry) {
      if (entry <= az) return e[entry];
      if (entry <= bz) return -e_platform[entry - bx];
      if (entry <= uy) return slide * (e[entry - ux] - e.z() * leg.u[entry - ux] / leg.u.z());
      return 1.0;
    };
    for (std::size_t c = 0; c < selected.size(); ++c) {
      const int j = selected[c];
      double& value = out.parameter(i, Eigen::Index(c));
      if (j < 0) continue;
      if (j < first_deformation) value = j / per_leg_ == i ? column_entry(entries[std::size_t(j % per_leg_)]) : 0.0;
      else if (j == first_deformation) value = -e_platform.z() * rho[std::size_t(i)];
      else if ((j - first_deformation - 1) / leg_count == i)
        value = -e_platform.z() * rho[std::size_t((j - first_deformation - 1) % leg_count)];
    }
    // A twist (v, ω) moves the platform joint by v + ω × joint.
    out.platform.row(i) << -e.transpose(), -joint.cross(e).transpose();
    out.actuator(i, i) = slides ? leg.u.dot(e) : 1.0;
    if (deformation.none) continue;
    out.actuator(i, i) -= deformation.kappa * e_platform.z();
    for (int j = 0; j < leg_count; ++j) out.actuator(i, j) -= deformation.K[std::size_t(6 * i + j)] * e_platform.z();
  }
}

}  // namespace posewright
