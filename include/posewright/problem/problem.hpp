#pragma once

#include <Eigen/Geometry>
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

/// Serial arm read from a URDF file: the chain from link `base` to link `tip`.
struct SerialArmSpec {
  std::filesystem::path urdf;                     ///< resolved against the problem file's folder
  int line = 0;                                   ///< of the key `urdf`
  std::optional<Located<std::string>> base, tip;  ///< default: root link, the only leaf link
  Placement placement;         ///< nominal pose of the base in the measurement frame (key `placement`)
  double encoder_noise = 0.0;  ///< 1σ of every joint reading (rad or m), 0 = exact
  /// User's name of a parameter → the model's name, e.g. px1 → joint_a2.x.
  std::vector<std::pair<std::string, Located<std::string>>> parameter_names;
};

/// One leg of a six-legged platform with prismatic actuators, all vectors in m (u dimensionless, normalised by the
/// reader).
struct LegSpec {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();   ///< base joint at ρ = 0, base frame
  Eigen::Vector3d b = Eigen::Vector3d::Zero();   ///< platform joint, platform frame
  Eigen::Vector3d u = Eigen::Vector3d::UnitZ();  ///< actuator direction, base frame
  double l = 0.0;                                ///< leg length
  int line = 0;
};

/// Six-legged parallel robot with prismatic base actuators (6-PUS telescope).
struct SixPusSpec {
  std::vector<LegSpec> legs;                      ///< exactly six
  Placement reference;                            ///< platform pose that configuration zero means
  double travel_lower = 0.0, travel_upper = 0.0;  ///< actuator stroke ρ (m)
  double actuator_noise = 0.0;                    ///< 1σ of ρ (m)
  int line = 0;
};

using RobotSpec = std::variant<SerialArmSpec, SixPusSpec>;

struct TargetSpec {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the tip (or platform) frame, m
  int line = 0;
};

/// Components of one measured quantity that the instrument delivers, e.g. x y z (0..2), rx ry rz (3..5); ascending.
using Components = std::vector<int>;

/// Full or partial pose of the tip. Rows: the chosen components of (x, y, z, rx, ry, rz), measurement frame.
struct PoseMeasurement {
  double position_sigma = 0.0;  ///< m, 1σ
  double rotation_sigma = 0.0;  ///< rad, 1σ
  Components components{0, 1, 2, 3, 4, 5};
};

/// Positions of one or more targets fixed to the tip. `position` in the file is `points` with one target.
struct PointsMeasurement {
  std::vector<TargetSpec> targets;
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  ///< m, 1σ along x, y, z of the measurement frame
  Components components{0, 1, 2};
};

struct MeasurementSpec {
  std::variant<PoseMeasurement, PointsMeasurement> instrument;
  int repeats = 1;             ///< readings averaged per configuration
  double repeatability = 0.0;  ///< 1σ (m) that stays at a pose and is not averaged away (robot repeatability)
  int line = 0;
};

/// One robot model with the set of parameters that calibration will estimate.
struct VariantSpec {
  std::string name;
  bool automatic = false;                        ///< parameters: auto = irreducible subset of the geometric ones
  std::vector<Located<std::string>> parameters;  ///< names or globs (* and ?), of interest
  std::vector<Located<std::string>> nuisance;    ///< names or globs
  std::vector<Located<std::string>> fixed;       ///< names or globs taken out again
  struct Tolerance {
    Located<std::string> pattern;
    double value = 0.0;  ///< SI
    enum class Quantity { length, angle, number } quantity = Quantity::number;
  };
  std::vector<Tolerance> tolerance;  ///< later entries win
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
