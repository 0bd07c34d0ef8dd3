#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "posewright/problem/robot_specs.hpp"

/// Measurement in a problem file: one plain struct per instrument, SI units.
namespace posewright {

struct TargetSpec {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, in the frame the key says
  int line = 0;
};

/// Components of one measured quantity that the instrument delivers, e.g. x y z (0..2), rx ry rz (3..5); ascending.
using Components = std::vector<int>;

/// Noise of one point: the same everywhere, in the axes of the station.
struct GaussianNoise {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< m²
};
/// Noise of a laser tracker, an ellipsoid along the line of sight (1σ): range + range_per_m·R along the beam,
/// transverse + angle·R across. Defaults: an interferometer's data sheet (theory.md eq. (10)).
struct TrackerNoise {
  double range = 2.5e-6, range_per_m = 0.075e-6;  ///< m, m/m
  double transverse = 3.75e-6, angle = 1.5e-6;    ///< m, rad
};
using PointNoise = std::variant<GaussianNoise, TrackerNoise>;

/// Station of an instrument. Its base pose is a set of parameters station.NAME.*.
struct StationSpec {
  std::string name;
  Placement placement;  ///< in the measurement frame
};

/// Full or partial pose of the tip. Rows: the chosen components of (x, y, z, rx, ry, rz), measurement frame; of an
/// instrument on the hand, the pose of the measurement frame in the tip.
struct PoseMeasurement {
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< m², m·rad, rad²
  Components components{0, 1, 2, 3, 4, 5};
  /// Photogrammetry: the covariance follows from the rigid fit to these points (tip frame, m) with `point_sigma` (m);
  /// empty: `covariance` counts.
  std::vector<TargetSpec> photogrammetry;
  double point_sigma = 0.0;
  bool on_hand = false;  ///< the tip carries the instrument, which reads a target that stands in the measurement frame
  bool joined = false;   ///< a joint keeps the readings at 0: the tip is joined to the measurement frame
};

/// Positions of one or more targets fixed to the tip. `position` in the file is `points` with one target.
struct PointsMeasurement {
  std::vector<TargetSpec> targets;
  PointNoise noise;
  std::vector<StationSpec> stations;  ///< empty: one, in the origin of the measurement frame
  Components components{0, 1, 2};
};

/// Distances: from fixed anchors to targets (ball bar, cable sensor), or between one target's places in two
/// configurations.
struct DistanceMeasurement {
  std::vector<TargetSpec> targets;            ///< tip frame
  std::vector<TargetSpec> anchors;            ///< measurement frame; empty: between two configurations
  double sigma = 0.0, sigma_per_m = 0.0;      ///< m, m/m (1σ = sigma + sigma_per_m · distance)
  double range_lower = 0.0, range_upper = 0;  ///< m, range of the instrument; upper 0: no limit
};

/// Distance of a probe on the tip from a plane, along its normal; a touch reads zero.
struct PlaneMeasurement {
  TargetSpec probe;                                   ///< tip frame
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< of the plane, measurement frame, m
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of length 1, measurement frame
  double radius = 0.0;                                ///< m, how far from the point the plane reaches
  double range_lower = 0.0, range_upper = 0.0;        ///< m
  double sigma = 0.0;                                 ///< m
};

/// Laser profiler on the tip: where a straight edge or a wire crosses the plane of its light.
struct LineMeasurement {
  Placement sensor;                                      ///< of the profiler's frame in the tip's; it sees in y = 0
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< middle of the line, measurement frame, m
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of length 1, measurement frame
  double length = 0.0, width = 0.0;                      ///< of the line; of the sensor's field in x, m
  double range_lower = 0.0, range_upper = 0.0;           ///< z in the sensor's frame, m
  double sigma = 0.0;                                    ///< m, of x and of z
};

/// Inclinometer on the tip: angles between its axes and the horizontal plane.
struct InclinationMeasurement {
  Components axes{0, 1};                          ///< of the sensor
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();  ///< of the sensor in the tip frame, rad
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< of length 1, measurement frame
  double range = 0.0;                             ///< rad, either way
  double sigma = 0.0;                             ///< rad
};

/// Pinhole camera with radial and tangential distortion (k1, k2, p1, p2, k3) and a board of known points.
struct CameraMeasurement {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  std::array<double, 5> distortion{};
  double width = 0, height = 0;  ///< px
  bool on_hand = true;           ///< camera on the tip and board fixed, or the other way round
  Placement camera, board;       ///< in the tip frame or the measurement frame, whichever carries it
  int rows = 0, columns = 0;     ///< of points
  double spacing = 0.0;          ///< m
  double sigma = 0.0;            ///< px, 1σ of each image coordinate
};

/// Redundant joint sensors of a closed chain.
struct JointsMeasurement {
  std::vector<Located<std::string>> sensors;  ///< empty: all the robot has
  double sigma = 0.0;                         ///< rad or m
  Quantity quantity = Quantity::number;       ///< quantity of its written unit; number: none, so SI
};

/// Limits of the line of sight. Angles rad, lengths m.
struct LineOfSightSpec {
  int visible = 0;  ///< targets that must be seen; 0: all
  std::optional<std::pair<double, double>> range, elevation, azimuth;
  std::optional<double> field_of_view;  ///< half angle of a cone about `axis`
  std::optional<Eigen::Vector3d> axis;  ///< unit, station frame; none: x, z of a camera
  std::optional<double> acceptance;     ///< largest angle between a target's normal and the line to the station
  std::vector<std::pair<Located<std::string>, Eigen::Vector3d>> normals;  ///< unit, tip frame (board frame of a camera)
  double beam = 0.004;                                                    ///< m, radius that must be free
  double target_radius = 0.01905;      ///< m, about the target, where nothing hides it: a 1.5 inch reflector
  std::vector<StationSpec> stations;   ///< of instruments that have none of their own (photogrammetry of a pose)
  std::vector<TargetSpec> references;  ///< measurement frame; measured again every `every` poses to watch drift
  int every = 0;
  int line = 0;
};

struct MeasurementSpec;
/// Several instruments: each pose is read by one of them. Those that read together are one, after its members.
struct InstrumentList {
  std::vector<MeasurementSpec> instruments;  ///< at least one, no two of a name
};

/// Instruments of a list that read the same visit: what the robot does not repeat is common to all of them.
struct TogetherMeasurement {
  std::vector<MeasurementSpec> members;  ///< at least two, copies of those in the list
};

using InstrumentSpec =
    std::variant<PoseMeasurement, PointsMeasurement, DistanceMeasurement, PlaneMeasurement, LineMeasurement,
                 InclinationMeasurement, CameraMeasurement, JointsMeasurement, InstrumentList, TogetherMeasurement>;

/// Repeatability, 1σ: a random displacement at every visit that averaging does not reduce. One displacement of
/// the tip, common to all that is read during the visit.
struct Repeatability {
  double translation = 0.0;  ///< m, each axis
  double rotation = 0.0;     ///< rad, about each axis through the tip
  /// m, each axis, of each target (or reading) on its own. No robot does this; it is there for virtual experiments that
  /// ask for the effect of another truth on a calibration.
  double independent = 0.0;

  bool operator==(const Repeatability&) const = default;
};

/// Of a list, the other members are those of its instruments. Only those have line_of_sight, most, reading and setup.
struct MeasurementSpec {
  InstrumentSpec instrument;
  std::string name;  ///< of an instrument of a list; else empty
  int repeats = 1;   ///< readings averaged per configuration
  Repeatability repeatability;
  std::optional<LineOfSightSpec> line_of_sight{};  ///< of an instrument of a list; of one alone the workspace has it
  double noise_factor = 1.0;  ///< of an instrument of a list: its noise is so many times as stated, by measured data
  std::optional<int> most{};  ///< poses that it may read; none: as many as are planned
  /// Of an instrument of a list: 1σ along each axis of a smooth displacement in its readings that other instruments do
  /// not have, m.
  double unmodelled = 0.0;
  std::optional<double> reading{}, setup{};  ///< s, as MotionSpec::reading and station_change, which count without
  bool loaded_minus_unloaded = false;        ///< differences between each load case and the first one, at the same pose
  int line = 0;
  /// Of a robot with several tips, as names: the tip that is seen, and the one that carries the measurement frame,
  /// none: the robot's base.
  std::optional<Located<std::string>> of{}, in{};
};

/// The instruments of a list; null for one alone.
inline const std::vector<MeasurementSpec>* instruments_of(const MeasurementSpec& measurement) {
  const auto* list = std::get_if<InstrumentList>(&measurement.instrument);
  return list == nullptr ? nullptr : &list->instruments;
}

/// MeasurementSpec::unmodelled of all instruments of a list; empty if none has one.
inline std::vector<double> own_effects(const MeasurementSpec& measurement) {
  std::vector<double> all;
  const auto* list = instruments_of(measurement);
  if (list == nullptr) return all;
  for (const MeasurementSpec& one : *list) all.push_back(one.unmodelled);
  return std::any_of(all.begin(), all.end(), [](double size) { return size > 0; }) ? all : std::vector<double>{};
}

/// True if a joint keeps two tips together (PoseMeasurement::joined): configurations that close the loop are a part of
/// the joints' box that has no volume.
inline bool joins_tips(const MeasurementSpec& measurement) {
  const auto joined = [](const MeasurementSpec& one) {
    const auto* pose = std::get_if<PoseMeasurement>(&one.instrument);
    return pose != nullptr && pose->joined;
  };
  const auto* list = instruments_of(measurement);
  return list == nullptr ? joined(measurement) : std::any_of(list->begin(), list->end(), joined);
}

/// Those that read if `instrument` does; null for one that reads alone.
inline const std::vector<MeasurementSpec>* members_of(const MeasurementSpec& instrument) {
  const auto* together = std::get_if<TogetherMeasurement>(&instrument.instrument);
  return together == nullptr ? nullptr : &together->members;
}

/// Calls use(instrument) for every instrument of a list, and for its copies in others, or for the one that there is.
template <class Use>
void for_each_instrument(MeasurementSpec& measurement, const Use& use) {
  if (auto* list = std::get_if<InstrumentList>(&measurement.instrument)) {
    for (MeasurementSpec& instrument : list->instruments) for_each_instrument(instrument, use);
    return;
  }
  use(measurement);
  if (auto* together = std::get_if<TogetherMeasurement>(&measurement.instrument))
    for (MeasurementSpec& member : together->members) use(member);
}

/// Mutable stations of its instrument; null for one without stations.
std::vector<StationSpec>* stations_of(MeasurementSpec& measurement);

}  // namespace posewright
