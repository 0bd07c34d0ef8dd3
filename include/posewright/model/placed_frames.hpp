#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "posewright/model/calibrated_values.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Frame without a place in a drawing: the robot's base, its tool, a station, a camera, a board.
struct PlacedFrame {
  std::string name;  ///< as its parameters begin: "base", "tool", "station.A", "camera", "board"
  std::string key;   ///< of the problem file that states it: "measurement: camera"; empty: none does
  std::string in;    ///< frame that X is from: "measurement", "tip" or "base"
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  std::string moved_by{};  ///< beginning of the parameters that move it; empty: its name
};

/// Base, tool (if it has parameters), places of the instrument and what it looks at, where the values of a variant's
/// parameters put them.
/// @param values  of the variant's whole model (calibrated_values())
/// Throws InputError where the robot's URDF can no longer be read.
std::vector<PlacedFrame> placed_frames(const ProblemVariant& variant, const std::vector<CalibratedValue>& values);

}  // namespace posewright
