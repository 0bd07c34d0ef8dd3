#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "posewright/problem/package_search.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/tasks/known_cameras.hpp"

namespace posewright {

/// A chessboard or grid of points.
struct BoardFacts {
  int rows = 6, columns = 9;  ///< of points: inner corners of a chessboard
  double spacing = 0.025;     ///< m
};

/// Reads ROWSxCOLUMNSxSPACING, "6x9x25mm". Throws InputError.
BoardFacts parse_board(const std::string& text);

/// Facts for a first problem file. Missing ones are found or chosen, with a comment in the file.
struct InitFacts {
  std::filesystem::path robot;    ///< URDF or .xacro
  std::filesystem::path samples;  ///< in place of a robot: poses of its tip and of a target (samples_problem)
  std::vector<std::pair<std::string, std::string>> xacro;
  Packages packages;
  std::string base;
  std::vector<std::string> tips;  ///< one: found if empty; several: each is read by an instrument of its own
  bool camera = false;            ///< else a laser tracker
  KnownCamera lens;
  BoardFacts board;
  bool on_hand = true;                   ///< the camera; else the board is
  bool arm = false;                      ///< of a camera: whether the arm's parameters are planned for too
  std::optional<Eigen::Vector3d> place;  ///< m, base frame: tracker, board of a camera on the hand, or fixed camera
  bool no_floor = false;
  std::optional<double> floor;     ///< m, height of floor or table in the base frame; none: under the robot's foot
  std::optional<int> poses;        ///< none: the number that reaches the accuracy, else a default
  std::optional<double> accuracy;  ///< m
  bool files_beside = true;        ///< the robot of a xacro file may be written beside the problem, expanded
  std::string schema;              ///< file in the modeline for editors; empty: no modeline
};

struct InitResult {
  std::string text;  ///< of the problem file
  std::string base;
  std::vector<std::string> tips;
  int joints = 0;
  std::vector<std::string> notes;  ///< default choices
  /// Expansion of the robot's xacro file, which `text` names in its place: to be written beside the problem. Empty for
  /// a URDF, and without InitFacts::files_beside.
  FileToWrite expanded;
};

/// The problem file, tried before it is returned: it is read, the cell is made, and a small pool of configurations
/// identifies the planned parameters. Where the instrument, or what it looks at, may stand anywhere, the first of some
/// places from which that holds is taken. Meshes that are not found leave out the cell, with a comment. If nearly every
/// configuration collides, the floor or the pair of links that does so most is left out, with a note and a comment.
/// Samples make the problem of samples_problem(); of the facts, only a fixed camera counts then.
/// @param file  where the text will be: paths in it are relative to its folder
/// Throws InputError as propose_chain(), for several tips that are not told apart, and for numbers out of range;
/// CannotDo where no pose is feasible from any place.
InitResult init_problem(const InitFacts& facts, const std::filesystem::path& file, const Monitor& monitor);

}  // namespace posewright
