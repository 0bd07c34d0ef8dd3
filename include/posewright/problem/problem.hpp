#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

/// Rigid placement: position (m) and fixed-axis roll, pitch, yaw (rad), R = Rz(yaw) Ry(pitch) Rx(roll) as in URDF.
struct Placement {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
};

/// A load on the tip of an arm. Force and moment in the measurement frame, payload in the tip frame.
struct LoadCaseSpec {
  std::string name;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();           ///< N, acts at `point`
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();          ///< N·m
  Eigen::Vector3d point = Eigen::Vector3d::Zero();           ///< m, tip frame
  double mass = 0.0;                                         ///< kg, payload; its weight acts at `centre_of_mass`
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();  ///< m, tip frame
};

/// Spring between the base and the link that one joint carries (design §3.3).
struct CompensatorSpec {
  Located<std::string> joint;
  double L = 0.0;                ///< m, radius of the pin on the link about the joint's axis
  double ax = 0.0, ay = 0.0;     ///< m, from the axis to the fixed pin
  double stiffness = 0.0;        ///< Kc, N/m
  double free_length = 0.0;      ///< s0, m
  double joint_stiffness = 0.0;  ///< K2⁰, N·m/rad
};

/// Joints as springs: reduced elastostatic model of an arm.
struct ElastostaticSpec {
  std::vector<std::pair<Located<std::string>, double>> compliance;  ///< nominal, by joint; rad/(N·m) or m/N, others 0
  Eigen::Vector3d gravity{0, 0, -9.81};                             ///< m/s², measurement frame
  bool link_gravity = false;                                        ///< weight of the links from the URDF's inertials
  std::vector<LoadCaseSpec> loads;                                  ///< at least one
  std::optional<CompensatorSpec> compensator;
  /// One compliance for each of these positions of one joint, which then takes no other.
  struct Listed {
    Located<std::string> joint;
    std::vector<double> at;  ///< rad or m, ascending
  };
  std::optional<Listed> listed;
  int line = 0;
};

/// Serial arm read from a URDF file: the chain from link `base` to link `tip`.
struct SerialArmSpec {
  std::filesystem::path urdf;                     ///< resolved against the problem file's folder
  int line = 0;                                   ///< of the key `urdf`
  std::optional<Located<std::string>> base, tip;  ///< default: root link, the only leaf link
  Placement placement;         ///< nominal pose of the base in the measurement frame (key `placement`)
  double encoder_noise = 0.0;  ///< 1σ of every joint reading (rad or m), 0 = exact
  /// User's name of a parameter → the model's name, e.g. px1 → joint_a2.x.
  std::vector<std::pair<std::string, Located<std::string>>> parameter_names;
  std::optional<ElastostaticSpec> elastostatic;
};

/// One leg of a six-legged platform, all vectors in m (u dimensionless, normalised by the reader).
struct LegSpec {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();   ///< base joint at ρ = 0, base frame
  Eigen::Vector3d b = Eigen::Vector3d::Zero();   ///< platform joint, platform frame
  Eigen::Vector3d u = Eigen::Vector3d::UnitZ();  ///< actuator direction, base frame (prismatic base joints only)
  double l = 0.0;                                ///< leg length at ρ = 0
  int line = 0;
};

/// What the actuators of a six-legged platform do: move the base joints along u (6-PUS) or lengthen the legs (Gough).
enum class LegActuation { slide, extend };

/// Six-legged parallel robot.
struct SixLegsSpec {
  LegActuation actuation = LegActuation::slide;
  std::vector<LegSpec> legs;                      ///< exactly six
  Placement placement;                            ///< nominal pose of the base in the measurement frame
  Placement reference;                            ///< platform pose (base frame) that configuration zero means
  double travel_lower = 0.0, travel_upper = 0.0;  ///< actuator stroke ρ (m)
  double actuator_noise = 0.0;                    ///< 1σ of ρ (m)
  int line = 0;
};

/// Planar five-bar: two legs of two links from fixed, actuated joints to one point. All in the base's x-y plane.
struct FiveBarSpec {
  struct Leg {
    Eigen::Vector2d base = Eigen::Vector2d::Zero();  ///< m
    double proximal = 0.0, distal = 0.0;             ///< link lengths, m
    double elbow = 1.0;  ///< +1: elbow to the left of the line base–point, −1: to the right
  };
  std::array<Leg, 2> legs;
  Placement placement;
  double encoder_noise = 0.0;                                 ///< 1σ of the actuated joints, rad
  double x_lower = 0, x_upper = 0, y_lower = 0, y_upper = 0;  ///< workspace of the point, m
};

/// Delta robot: three arms on a base circle, parallelogram forearms, a platform that only translates.
struct DeltaSpec {
  double base_radius = 0.0, platform_radius = 0.0, arm = 0.0, forearm = 0.0;  ///< m
  Placement placement;
  double encoder_noise = 0.0;                 ///< 1σ, rad
  double travel_lower = 0, travel_upper = 0;  ///< of the arms' angles below the horizontal, rad
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Zero();  ///< workspace box, m
};

/// The linkage of a gravity compensator alone: where its pins are, from markers over the joint's range.
struct CompensatorGeometrySpec {
  double L = 0.0, ax = 0.0, ay = 0.0;  ///< m, as in CompensatorSpec
  double lower = 0.0, upper = 0.0;     ///< range of q2, rad
  double encoder_noise = 0.0;          ///< 1σ of q2, rad
};

using RobotSpec = std::variant<SerialArmSpec, SixLegsSpec, FiveBarSpec, DeltaSpec, CompensatorGeometrySpec>;

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
/// transverse + angle·R across. Defaults: an interferometer's data sheet (design §3.5).
struct TrackerNoise {
  double range = 2.5e-6, range_per_m = 0.075e-6;  ///< m, m/m
  double transverse = 3.75e-6, angle = 1.5e-6;    ///< m, rad
};
using PointNoise = std::variant<GaussianNoise, TrackerNoise>;

/// Where an instrument stands. Its base pose is a set of parameters station.NAME.*.
struct StationSpec {
  std::string name;
  Placement placement;  ///< in the measurement frame
};

/// Full or partial pose of the tip. Rows: the chosen components of (x, y, z, rx, ry, rz), measurement frame.
struct PoseMeasurement {
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< m², m·rad, rad²
  Components components{0, 1, 2, 3, 4, 5};
  /// Photogrammetry: the covariance follows from the rigid fit to these points (tip frame, m) with `point_sigma` (m);
  /// empty: `covariance` counts.
  std::vector<TargetSpec> photogrammetry;
  double point_sigma = 0.0;
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
  double range_lower = 0.0, range_upper = 0;  ///< m, what the instrument can span; upper 0: anything
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
};

using InstrumentSpec =
    std::variant<PoseMeasurement, PointsMeasurement, DistanceMeasurement, CameraMeasurement, JointsMeasurement>;

struct MeasurementSpec {
  InstrumentSpec instrument;
  int repeats = 1;                     ///< readings averaged per configuration
  double repeatability = 0.0;          ///< 1σ (m) that stays at a pose and is not averaged away (robot repeatability)
  bool loaded_minus_unloaded = false;  ///< differences between each load case and the first one, at the same pose
  int line = 0;
};

/// One robot model with the set of parameters that calibration will estimate.
struct VariantSpec {
  std::string name;
  /// Where the names come from: the robot's joint frames or its Denavit–Hartenberg parameters, distal or proximal
  /// (modified).
  enum class Convention { frames, dh, mdh } convention = Convention::frames;
  bool automatic = false;                        ///< auto, dh, mdh: irreducible subset of the geometric ones
  std::vector<Located<std::string>> parameters;  ///< names or globs (* and ?), of interest
  std::vector<Located<std::string>> nuisance;    ///< names or globs
  std::vector<Located<std::string>> fixed;       ///< names or globs taken out again
  struct Tolerance {
    Located<std::string> pattern;
    double value = 0.0;  ///< SI
    enum class Quantity { length, angle, compliance, number } quantity = Quantity::number;
  };
  std::vector<Tolerance> tolerance;  ///< later entries win
  std::vector<Tolerance> nominal;    ///< values that this variant is linearised at, in place of the robot's
  int line = 0;
};

/// Limits for one configuration coordinate that replace (and may only narrow) the robot's own.
struct CoordinateLimits {
  Located<std::string> name;
  double lower = 0.0, upper = 0.0;
  Quantity quantity = Quantity::number;  ///< kind of unit written (length, angle); number: none, so SI
};

struct WorkspaceSpec {
  double joint_margin = 0.0;             ///< rad, kept from both ends of revolute limits
  double joint_margin_length = 0.0;      ///< m, the same for prismatic joints
  std::vector<CoordinateLimits> limits;  ///< `joints: limits:` or `pose:` of a platform
};

enum class Repeats { forbid, allow };

struct DesignSpec {
  std::optional<Located<std::string>> variant;  ///< default: the first
  Located<std::string> criterion{"o1", 0};
  Located<std::string> method{"exchange", 0};
  std::optional<Located<int>> poses;
  Located<int> candidates{10000, 0};
  Located<int> restarts{10, 0};
  Repeats repeats = Repeats::forbid;
  bool prior = false;  ///< count the tolerances as prior knowledge: M = GᵀG + diag(1/tolerance²)
  int line = 0;
};

/// A whole problem file.
struct Problem {
  std::filesystem::path file;
  std::string sha256;  ///< of the file's bytes, lower-case hexadecimal
  RobotSpec robot;
  int robot_line = 0;
  MeasurementSpec measurement;
  std::vector<VariantSpec> variants;  ///< at least one
  WorkspaceSpec workspace;
  DesignSpec design;

  SourcePlace at(int line) const { return {file.string(), line}; }
};

}  // namespace posewright
