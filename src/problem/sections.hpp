#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "yaml_section.hpp"

/// One reader for each section of the problem file.
namespace posewright {

/// The path of the URDF file is relative to the folder of `file`, or of a package.
RobotSpec read_robot(const yaml::Value& value, const std::filesystem::path& file, const Packages& packages);

bool is_xacro(const std::filesystem::path& file);
/// Expansion of the arm's file by the program `xacro`. Throws at `urdf` where arguments without default are missing,
/// where there is no such program, and where it fails.
std::string expanded_xacro(const SerialArmSpec& arm, const yaml::Value& urdf);

MeasurementSpec read_measurement(const yaml::Value& value);
/// Key `tips` of the robot and what instruments see of them: the ways of the arm, or its base and tip where there is
/// one way alone. Of a problem whose other sections are read.
void read_ways(const yaml::Section& root, Problem& problem);
DistanceMeasurement read_distance(const yaml::Section& section);
PlaneMeasurement read_plane_distance(const yaml::Section& section);
LineMeasurement read_line(const yaml::Section& section);
InclinationMeasurement read_inclination(const yaml::Section& section);
CameraMeasurement read_camera(const yaml::Section& section);
JointsMeasurement read_joint_sensors(const yaml::Section& section);

/// Poses of a plan or an instrument.
inline constexpr int most_stated_poses = 1'000'000;

/// Refuses keys of an instrument that are neither its own nor any instrument's.
void allow_instrument(const yaml::Section& section, std::initializer_list<std::string_view> own);
/// Chosen components as ascending indices into `names`.
Components read_components(const yaml::Value& value, std::span<const std::string_view> names);
/// {NAME: [x, y, z]}, at least one.
std::vector<TargetSpec> read_targets(const yaml::Value& value);

/// Key `elastostatic` of a serial arm.
ElastostaticSpec read_elastostatic(const yaml::Value& value);

/// Robots other than serial arms, by the key `model`.
SixLegsSpec read_six_legs(const yaml::Section& robot, LegActuation actuation);
FiveBarSpec read_five_bar(const yaml::Section& robot);
DeltaSpec read_delta(const yaml::Section& robot);
CompensatorGeometrySpec read_compensator_geometry(const yaml::Section& robot);

/// {GLOB: value with unit}.
std::vector<PatternValue> read_pattern_values(const yaml::Value& value, yaml::Sign sign);

std::vector<VariantSpec> read_variants(const yaml::Value& value);

/// The kind of robot decides which keys there are. `folder` is what paths are relative to.
WorkspaceSpec read_workspace(const yaml::Value& value, const RobotSpec& robot, const std::filesystem::path& folder);
CollisionSpec read_collision(const yaml::Value& value, const std::filesystem::path& folder);
LineOfSightSpec read_line_of_sight(const yaml::Value& value);
StationChoiceSpec read_station_choice(const yaml::Value& value);
MotionSpec read_motion(const yaml::Value& value);

/// {NAME: [x, y, z] or {position, rpy}}, at least one.
std::vector<StationSpec> read_stations(const yaml::Value& value);
/// A vector of length 1 from one that is not zero.
Eigen::Vector3d read_direction(const yaml::Value& value);

/// Throws where the design names none of the variants. `folder` is what paths are relative to.
DesignSpec read_design(const yaml::Value& value, const std::vector<VariantSpec>& variants,
                       const std::filesystem::path& folder);
TestPosesSpec read_test_poses(const yaml::Value& value, const std::filesystem::path& folder);

/// {position, rpy}, both optional and zero by default.
Placement read_placement(const yaml::Section& section);

/// x, y, z, rx, ry, rz as the file writes the components of a pose.
inline constexpr std::array<std::string_view, 6> pose_components{"x", "y", "z", "rx", "ry", "rz"};

}  // namespace posewright
