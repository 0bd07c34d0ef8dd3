#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/cell/line_of_sight.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

using Eigen::Isometry3d, Eigen::Matrix3d, Eigen::Vector3d;

// Where nothing says how far targets may be turned away: a board is found up to about so much.
constexpr double usual_tilt = std::numbers::pi / 3;
// Where nothing says how far off a camera may be: so many times the distance at which its targets fill the picture.
constexpr double usual_reach = 3.0;

Matrix3d turned(const Vector3d& axis, double angle) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

Matrix3d turning(const Vector3d& from, const Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

/// Evenly within a cone about a unit vector.
Vector3d within_cone(const Vector3d& axis, double half_angle, Random& random) {
  const double z = random.uniform(std::cos(half_angle), 1.0), around = random.uniform(0.0, 2 * std::numbers::pi);
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return turning(Vector3d::UnitZ(), axis) * Vector3d(r * std::cos(around), r * std::sin(around), z);
}

double any_turn(Random& random) { return random.uniform(0.0, 2 * std::numbers::pi); }

}  // namespace

/// All targets together, in the frame that carries them.
struct LineOfSight::Bundle {
  Vector3d centre = Vector3d::Zero();
  double radius = 0.0;
  Vector3d front = Vector3d::Zero();  // unit; zero: they have none
};

LineOfSight::Bundle LineOfSight::bundle() const {
  Bundle all;
  for (const Target& target : targets_) all.centre += target.position / double(targets_.size());
  for (const Target& target : targets_) {
    all.radius = std::max(all.radius, (target.position - all.centre).norm());
    if (target.normal) all.front += *target.normal;
  }
  if (all.front.norm() > 1e-9) all.front.normalize();
  else all.front.setZero();
  return all;
}

double LineOfSight::distance_to(const Bundle& all, Random& random) const {
  const double fits = half_angle_ ? all.radius / std::tan(*half_angle_) : 0.0;
  const double far = spec_.range ? spec_.range->second : usual_reach * fits;
  const double near = std::max(spec_.range ? spec_.range->first : 0.0, fits);
  return near < far ? random.uniform(near, far) : far;
}

bool LineOfSight::can_propose() const {
  return !targets_.empty() &&
         (half_angle_.has_value() || (!station_on_tip_ && spec_.acceptance && targets_.front().normal));
}

Isometry3d LineOfSight::propose_tip(std::span<const double> q, Random& random) const {
  const auto [first, last] = stations_of(q);
  const int station = first + random.index(last - first + 1);
  const Isometry3d X_Tip = model_.tool_pose(q);
  const Isometry3d& X_Carrier = X_CarrierStation_[std::size_t(station)];
  if (station_on_tip_) return station_before_targets(X_Tip * X_Carrier, random) * X_Carrier.inverse();
  return targets_before_station(X_Carrier, X_Tip, random);
}

Isometry3d LineOfSight::station_before_targets(const Isometry3d& X_Station, Random& random) const {
  const Bundle all = bundle();
  Vector3d front = all.front;
  // A board without a front is looked at from the side where the camera is.
  if (front.isZero()) {
    front = X_CarrierTarget_.linear().col(2);
    if (front.dot(X_Station.translation() - all.centre) < 0) front = -front;
  }
  const double distance = distance_to(all, random);
  const Vector3d away = within_cone(front, spec_.acceptance.value_or(usual_tilt), random);
  const double spare = half_angle_.value_or(0.0) - std::atan2(all.radius, distance);
  const Vector3d ahead = within_cone(-away, std::max(0.0, spare), random);
  Isometry3d X = Isometry3d::Identity();
  X.linear() = turned(ahead, any_turn(random)) * turning(*spec_.axis, ahead);
  X.translation() = all.centre + distance * away;
  return X;
}

Isometry3d LineOfSight::targets_before_station(const Isometry3d& X_Station, const Isometry3d& X_Tip,
                                               Random& random) const {
  const Bundle all = bundle();
  Vector3d centre = X_Tip * all.centre, front = X_Tip.linear() * all.front;
  if (half_angle_) {
    const double distance = distance_to(all, random);
    const double spare = *half_angle_ - std::atan2(all.radius, distance);
    centre = X_Station * Vector3d(distance * within_cone(*spec_.axis, std::max(0.0, spare), random));
    if (front.isZero()) front = X_Tip.linear() * X_CarrierTarget_.linear().col(2);
  } else if (spec_.range) {
    const Vector3d way = centre - X_Station.translation();
    const double distance = way.norm();
    if (distance > 1e-9 && (distance < spec_.range->first || distance > spec_.range->second))
      centre = X_Station.translation() + way / distance * random.uniform(spec_.range->first, spec_.range->second);
  }
  Isometry3d X = X_Tip;
  if (!front.isZero()) {
    const Vector3d back = (X_Station.translation() - centre).normalized();
    const Vector3d wanted = within_cone(back, spec_.acceptance.value_or(usual_tilt), random);
    X.linear() = turned(wanted, any_turn(random)) * turning(front, wanted) * X_Tip.linear();
  }
  X.translation() = centre - X.linear() * all.centre;
  return X;
}

}  // namespace posewright
