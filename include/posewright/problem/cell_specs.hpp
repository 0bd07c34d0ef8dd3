#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "posewright/problem/measurement_specs.hpp"

/// Cell around the robot in a problem file: plain structs, SI units.
namespace posewright {

struct BoxShape {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< m, edges along x, y, z
};
/// Axis along z, centre in the origin.
struct CylinderShape {
  double radius = 0.0, length = 0.0;  ///< m
};
struct SphereShape {
  double radius = 0.0;  ///< m
};
/// Half space on the far side of a plane through the origin from where `normal` points: floor, wall.
struct HalfSpaceShape {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
};
/// Triangles of a file (STL, OBJ, Collada), in m once multiplied by `scale`.
struct MeshShape {
  std::filesystem::path file;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};
/// Triangles that a file of a whole scene holds.
struct TrianglesShape {
  std::vector<Eigen::Vector3d> vertices;  ///< m
  std::vector<std::array<int, 3>> triangles;
};
using ShapeSpec = std::variant<BoxShape, CylinderShape, SphereShape, HalfSpaceShape, MeshShape,
                               std::shared_ptr<const TrianglesShape>>;

/// An obstacle (placement in the measurement frame) or a part of the tool (placement in the tip frame).
struct BodySpec {
  std::string name;
  ShapeSpec shape;
  Placement placement;
  std::string station;  ///< the instrument whose own body this is: it does not hide its own sight; empty: nobody's
  int line = 0;
  std::optional<Located<std::string>> tip{};  ///< of a part of the tool of a robot with several tips: which carries it
};

/// Obstacles of a file: an SDF or URDF world, a MoveIt scene.
struct ObstacleFileSpec {
  std::filesystem::path file;
  Placement placement;                       ///< of the file's world in the measurement frame
  std::vector<Located<std::string>> except;  ///< models, links or objects that are left out, such as the robot itself
  int line = 0;
};

struct CollisionSpec {
  bool self = true;
  double clearance = 0.0;  ///< m, kept from obstacles
  /// m, kept between links and between tool and links; not given: `clearance`.
  std::optional<double> self_clearance;
  /// Self clearance of two bodies by their names.
  struct PairClearance {
    Located<std::string> first, second;
    double clearance = 0.0;
  };
  std::vector<PairClearance> pair_clearances;
  bool hulls = false;  ///< meshes are replaced by their convex hulls
  std::optional<Located<std::filesystem::path>> srdf;
  /// Pairs of links or tool parts that may touch.
  std::vector<std::pair<Located<std::string>, Located<std::string>>> ignore;
  std::vector<BodySpec> tool, obstacles;
  std::vector<ObstacleFileSpec> obstacle_files;
  int line = 0;
};

/// Limits of Σ factor · coordinate.
struct CoupledLimits {
  std::vector<std::pair<Located<std::string>, double>> factors;
  double lower = 0.0, upper = 0.0;
  Quantity quantity = Quantity::number;  ///< kind of unit written
  int line = 0;
};

/// Box for a point of the tool, measurement frame.
struct ToolBoxSpec {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, tip frame
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(-1e9), upper = Eigen::Vector3d::Constant(1e9);
};

/// Smallest singular value of the tip's Jacobian, rows of rotation as they are, of translation divided by `length`.
struct SingularitySpec {
  double smallest = 0.0;
  double length = 1.0;  ///< m
  int line = 0;
};

/// Motion of the robot between poses.
struct MotionSpec {
  std::vector<std::pair<Located<std::string>, Measured>> velocity, acceleration;  ///< replace the robot's own
  std::vector<std::pair<Located<std::string>, Measured>> home;                    ///< coordinates left out are zero
  double speed = 1.0;                ///< share of the velocities that is used
  double settle = 0.0;               ///< s, standstill at each pose before it is read
  double reading = 0.0;              ///< s, of one target in one reading
  double station_change = 900;       ///< s, from one station or instrument to another
  double load_change = 300;          ///< s, from one load case to another
  double temperature_change = 3600;  ///< s, until the robot has another of the temperatures that are asked for
  bool reachable = false;            ///< every pose must be connected with home
  int line = 0;
};

/// Stations to choose among.
struct StationChoiceSpec {
  std::vector<StationSpec> list;
  int choose = 1;
  int line = 0;
};

}  // namespace posewright
