#include "compensator_geometry.hpp"

#include <cmath>
#include <numbers>

#include "displacement.hpp"
#include "point_noise.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

enum Parameters { length, pin_x, pin_y, offset, base };

constexpr double linkage_length_tolerance = 5e-3, linkage_angle_tolerance = std::numbers::pi / 180;  // m, rad

/// Measurement spec reduced to what the two markers need.
const PointsMeasurement& markers_of(const MeasurementSpec& measurement) {
  const auto* points = std::get_if<PointsMeasurement>(&measurement.instrument);
  if (points == nullptr || points->targets.size() != 2 || points->components.size() != 3 || !points->stations.empty())
    throw CannotDo(
        "measurement: a compensator needs type: points with the targets P0 and P1, seen from the measurement frame: no "
        "stations");
  for (const TargetSpec& target : points->targets)
    if ((target.name != "P0" && target.name != "P1") || !target.position.isZero())
      throw CannotDo("measurement: the targets of a compensator are P0: [0, 0, 0] and P1: [0, 0, 0], on the pins");
  return *points;
}

}  // namespace

CompensatorGeometry::CompensatorGeometry(const CompensatorGeometrySpec& spec, const MeasurementSpec& measurement)
    : spec_(spec),
      noise_(markers_of(measurement).noise),
      repeats_(measurement.repeats),
      repeatability_(measurement.repeatability.translation) {
  if (measurement.repeatability.rotation > 0)
    throw CannotDo("measurement: repeatability of a compensator's pins is a length; it has no tip that could turn");
  parameters_ = {{"L", "m", spec.L, linkage_length_tolerance, Role::interest},
                 {"ax", "m", spec.ax, linkage_length_tolerance, Role::interest},
                 {"ay", "m", spec.ay, linkage_length_tolerance, Role::interest},
                 {"q2.offset", "rad", 0.0, linkage_angle_tolerance, Role::interest}};
  append_displacement(parameters_, "base", Eigen::Isometry3d::Identity(), 10e-3, linkage_angle_tolerance);
  for (int i = 0; i < int(parameters_.size()); ++i) geometric_.push_back({i, i >= base ? 0 : i == offset ? 2 : 1});
  coordinates_ = {{"q2", "rad", spec.lower, spec.upper}};
  for (const char* pin : {"P0", "P1"})
    for (const char* axis : {".x", ".y", ".z"}) readings_.push_back({std::string(pin) + axis, "m"});
  rows_ = 6;
}

CompensatorGeometry::Pins CompensatorGeometry::pins(const Point& at) const {
  const auto corrected = [&](double nominal, std::size_t i) {
    return nominal + (at.correction.empty() ? 0.0 : at.correction[i]);
  };
  Pins pins;
  pins.L = corrected(spec_.L, length);
  const double angle = at.q[0] + corrected(0.0, offset);
  pins.along = {std::sin(angle), std::cos(angle), 0};
  pins.across = {std::cos(angle), -std::sin(angle), 0};
  pins.base = displace(pins.frame, at.correction.empty() ? nullptr : at.correction.data() + base);
  pins.P0 = pins.frame.R * Eigen::Vector3d(-corrected(spec_.ax, pin_x), -corrected(spec_.ay, pin_y), 0) + pins.frame.p;
  pins.P1 = pins.frame.R * (pins.L * pins.along) + pins.frame.p;
  return pins;
}

bool CompensatorGeometry::do_read(const Point& at, Eigen::VectorXd& y) const {
  const Pins placed = pins(at);
  y << placed.P0, placed.P1;
  return true;
}

bool CompensatorGeometry::do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const {
  const auto [frame, axes, along, across, P0, P1, L] = pins(at);
  out.G.setZero(rows_, Eigen::Index(selected.size()));
  for (std::size_t c = 0; c < selected.size(); ++c) {
    auto column = out.G.col(Eigen::Index(c));
    switch (selected[c]) {
      case length:
        column.tail<3>() = frame.R * along;
        break;
      case pin_x:
        column.head<3>() = -frame.R.col(0);
        break;
      case pin_y:
        column.head<3>() = -frame.R.col(1);
        break;
      case offset:
        column.tail<3>() = L * (frame.R * across);
        break;
      default: {
        const Twist twist = axes.twist(selected[c] - base);
        const Eigen::Vector3d w = twist.tail<3>();
        column << twist.head<3>() + w.cross(P0), twist.head<3>() + w.cross(P1);
      }
    }
  }
  out.covariance.setZero(rows_, rows_);
  out.covariance.topLeftCorner<3, 3>() = point_covariance(noise_, P0) / repeats_;
  out.covariance.bottomRightCorner<3, 3>() = point_covariance(noise_, P1) / repeats_;
  out.share_readings();
  // The fixed pin stays; the link's pin stands elsewhere at every visit.
  out.covariance.diagonal().tail<3>().array() += repeatability_ * repeatability_;
  const Eigen::Vector3d swing = spec_.encoder_noise * L * (frame.R * across);
  out.covariance.bottomRightCorner<3, 3>() += swing * swing.transpose();
  return true;
}

Eigen::Isometry3d CompensatorGeometry::do_tool_pose(const Point& at) const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = spec_.L * Eigen::Vector3d(std::sin(at.q[0]), std::cos(at.q[0]), 0);
  return X;
}

}  // namespace posewright
