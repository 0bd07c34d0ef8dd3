#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "posewright/model/link_geometry.hpp"
#include "posewright/model/propose_chain.hpp"
#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/file.hpp"
#include "posewright/tasks/init_problem.hpp"

namespace posewright {

/// Facts about the robot.
struct InitRobot {
  ProposedChain links;
  ChainDescription chain;
  RootPlace root;                    ///< in which the cell stands if joints of the way move the base
  double reach = 0.0;                ///< m, no point of the tip is farther from the first joint
  Eigen::Vector3d outward{0, 0, 1};  ///< tip frame, unit, along an axis: where a tool points
  std::string urdf;                  ///< as the problem file names it
  double lowest = 0.0;               ///< m, of what the arm stands on; base, or root if it moves; at most 0
  double face = 0.0;                 ///< m, how far bodies reach beyond the tip along `outward`
  std::shared_ptr<const std::string> expanded{};  ///< by xacro; null: the file is a URDF
};

/// Facts about the robot of the file as it is to each tip, at least one. Throws as init_problem().
std::vector<InitRobot> look_at_robot(const InitFacts& facts, const std::filesystem::path& file);
/// Joints of the ways to all tips, each once.
std::vector<Coordinate> joints_of(const std::vector<InitRobot>& tips);
/// Adds `lowest` and `face`. Throws InputError where meshes are missing, and for links that are far larger or smaller
/// than the arm: a scale is missing or one too many.
void add_bodies(InitRobot& robot, const Problem& problem);
/// Expansion of the robot's xacro file, to be written beside the problem `file`; meshes are named so that they are
/// found from there. Empty for a URDF.
FileToWrite expanded_robot(const InitFacts& facts, const InitRobot& robot, const std::filesystem::path& file);

/// Two bodies that hinder nearly all configurations: one of them the floor, or two links.
struct InitObstacle {
  std::string first, second;  ///< a link, a link or "floor"
  double share = 0.0;         ///< of random configurations in which they are too near

  bool is_floor() const { return second == floor_name; }
  static constexpr const char* floor_name = "floor";
};

/// Place of the instrument or its target, and presence of a cell.
struct InitPlace {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d view{0, 0, -1};   ///< unit, base frame: from the camera to the board
  std::vector<std::string> held{};  ///< parameters of the hand-eye variant that no motion separates from the others
  bool cell = true;
  std::string no_cell{};  ///< why there is none
  /// Collision-free home, each joint and its value; empty: no motions are searched.
  std::vector<std::pair<Coordinate, double>> home{};
  std::vector<InitObstacle> left_out{};  ///< written as comments, or ignored, so that a plan can be made
};

/// The commented file.
/// @param expanded  file beside it that xacro made; empty: the robot is named as the user did
std::string init_text(const InitFacts& facts, const std::vector<InitRobot>& tips, const InitPlace& place,
                      const std::filesystem::path& expanded = {});

/// The camera is on a base that joints of the way move.
inline bool on_moving_base(const InitFacts& facts, const InitRobot& robot) {
  return facts.camera && !facts.on_hand && robot.root.base_moves();
}

/// Point of the tip's frame at which camera or board is mounted.
Eigen::Vector3d mounted_at(const InitFacts& facts, const InitRobot& robot);

/// Least and largest distance of camera and board, m: from where the board fills half of the image to where its points
/// are some 12 px apart.
std::pair<double, double> sight_range(const InitFacts& facts);

/// Height of the floor, m in the base frame, or in the root's if the base moves: what is said, else under the bodies
/// that stand still; none: no floor.
std::optional<double> floor_of(const InitFacts& facts, const InitRobot& robot);

/// Poses that are asked for if nobody says how many.
int default_poses(const InitFacts& facts);

}  // namespace posewright
