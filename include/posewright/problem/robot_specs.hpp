#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"

/// Robot in a problem file: one plain struct per kind, SI units.
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

/// Spring between the base and the link that one joint carries (theory.md eq. (13)).
struct CompensatorSpec {
  Located<std::string> joint;
  double L = 0.0;                ///< m, radius of the pin on the link about the joint's axis
  double ax = 0.0, ay = 0.0;     ///< m, from the axis to the fixed pin
  double stiffness = 0.0;        ///< Kc, N/m
  double free_length = 0.0;      ///< s0, m
  double joint_stiffness = 0.0;  ///< K2⁰, N·m/rad
  /// False: the spring stiffens the joint, and the load bends it; the effect of spring and links on the unloaded arm is
  /// in the controller's zero. True: the spring's own torque bends the joint, too.
  bool torque = false;
};

/// Joints as springs: reduced elastostatic model of an arm.
struct ElastostaticSpec {
  std::vector<std::pair<Located<std::string>, Measured>> compliance;  ///< nominal, by joint; rad/(N·m) or m/N, others 0
  Eigen::Vector3d gravity{0, 0, -9.81};                               ///< m/s², measurement frame
  bool link_gravity = false;                                          ///< weight of the links from the URDF's inertials
  std::vector<LoadCaseSpec> loads;                                    ///< at least one
  std::optional<CompensatorSpec> compensator;
  /// Linkage of a compensator whose joint has listed compliances: its constants follow from them after a calibration
  /// (key `compensator_from`), so that geometry alone is set.
  std::optional<CompensatorSpec> derived_compensator;
  /// One compliance for each of these positions of one joint, which then takes no other.
  struct Listed {
    Located<std::string> joint;
    std::vector<double> at;                ///< rad or m, in the file's order
    Quantity quantity = Quantity::number;  ///< quantity of the written units; number: none, so SI
  };
  std::optional<Listed> listed;
  int line = 0;
};

/// Effects of a joint besides its reading (model/joint_effects.hpp).
struct JointEffectsSpec {
  Located<std::string> joint;                  ///< a name or a glob
  bool eccentricity = false;                   ///< first and second harmonic of the joint's angle
  std::optional<double> gear_ratio;            ///< periods of the gear's error in one turn of the joint
  std::vector<Located<std::string>> coupling;  ///< joints that it follows a little
  bool backlash = false;                       ///< it stands elsewhere by the side that it came from
  std::optional<Measured> overrun;             ///< that a route comes from beyond; none: 2 deg or 5 mm
  bool temperature = false;                    ///< it drifts with the robot's temperature
};

/// Temperatures of the robot, °C.
struct TemperatureSpec {
  double reference = 20.0;  ///< where nothing is added
  std::vector<double> at;   ///< at which a plan may have poses measured, ascending; never empty
};

/// A link that instruments see, or that carries their measurement frame.
struct TipSpec {
  std::string name;           ///< as `of` and `in` of instruments call it
  Located<std::string> link;  ///< of the URDF
};

/// A way that instruments measure, from the link that carries their measurement frame to the one that they see.
struct WaySpec {
  std::optional<TipSpec> in;  ///< none: the robot's base
  TipSpec of;
};

/// Serial arm read from a URDF file: the chain from link `base` to link `tip`; with `tips`, the joints of several ways.
struct SerialArmSpec {
  std::filesystem::path urdf;                     ///< resolved against the problem file's folder
  int line = 0;                                   ///< of the key `urdf`
  std::optional<Located<std::string>> base, tip;  ///< default: root link, the only leaf link
  /// Those of all instruments (MeasurementSpec::of, in), each once, if they are several: then `tip` is empty. Empty:
  /// all measure the way from base to tip.
  std::vector<WaySpec> ways;
  std::optional<Located<std::filesystem::path>> srdf;
  std::optional<Located<std::string>> group;                        ///< of the SRDF, whose chain gives base and tip
  std::vector<std::pair<Located<std::string>, std::string>> xacro;  ///< arguments, where `urdf` is a xacro file
  std::shared_ptr<const std::string> expanded;                      ///< its expansion by xacro; null: `urdf` is URDF
  std::vector<std::pair<Located<std::string>, Measured>> hold;      ///< joints by name or glob; m or rad, of all poses
  Placement placement;         ///< nominal pose of the base in the measurement frame (key `placement`)
  double encoder_noise = 0.0;  ///< 1σ of every joint reading (rad or m), 0 = exact
  /// User's name of a parameter → the model's name, e.g. px1 → joint_a2.x.
  std::vector<std::pair<std::string, Located<std::string>>> parameter_names;
  std::optional<ElastostaticSpec> elastostatic;
  std::vector<JointEffectsSpec> joint_effects;
  std::optional<TemperatureSpec> temperature;
};

/// One leg of a six-legged platform, all vectors in m (u dimensionless, normalised by the reader).
struct LegSpec {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();   ///< base joint at ρ = 0, base frame
  Eigen::Vector3d b = Eigen::Vector3d::Zero();   ///< platform joint, platform frame
  Eigen::Vector3d u = Eigen::Vector3d::UnitZ();  ///< actuator direction, base frame (prismatic base joints only)
  double l = 0.0;                                ///< leg length at ρ = 0
  int line = 0;
};

/// Actuation of a six-legged platform: actuators move the base joints along u (6-PUS) or lengthen the legs (Gough).
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

/// A robot without a model: the poses of its tip are given.
struct GivenPosesSpec {
  Placement placement;  ///< nominal pose of the base in the measurement frame
  Placement tool;       ///< nominal pose of the instrument, or of what it looks at, on the tip
};

using RobotSpec =
    std::variant<SerialArmSpec, SixLegsSpec, FiveBarSpec, DeltaSpec, CompensatorGeometrySpec, GivenPosesSpec>;

/// True if x, y, z, rx, ry, rz of a pose are the coordinates, else joints.
inline bool moves_by_pose(const RobotSpec& robot) {
  return std::holds_alternative<SixLegsSpec>(robot) || std::holds_alternative<GivenPosesSpec>(robot);
}

/// Noise (1σ, rad or m) of the robot's joint or actuator readings; nothing for a robot without them.
void set_joint_noise(RobotSpec& robot, double sigma);

}  // namespace posewright
