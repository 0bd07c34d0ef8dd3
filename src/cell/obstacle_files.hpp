#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "mesh_file.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// A shape that a file of obstacles has, in that file's world.
struct PlacedShape {
  std::string name;  ///< several shapes of one body have the same
  ShapeSpec shape;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  int line = 0;  ///< in the file, 0: not known
};

/// All shapes of a file, by its ending: .sdf and .world (SDF), .urdf (joints at zero), .scene (MoveIt's text form).
/// Throws InputError for other endings, files that cannot be read, shapes of a kind that is not, and names in `except`
/// that the file does not have.
std::vector<PlacedShape> read_obstacle_file(const ObstacleFileSpec& spec, const NamedFiles& files);

/// Collision shapes of an SDF world (1.4 or later), or of the model of an SDF file, with all it includes;
/// `model::link` where a model has several links. Throws InputError for models that are neither found nor left out,
/// frames that are not there, and shapes of a kind that is not read.
std::vector<PlacedShape> read_sdf_shapes(const ObstacleFileSpec& spec, const NamedFiles& files);

/// Objects of the text that MoveIt's planning scene writes, with poses of objects (since 2021) or without.
std::vector<PlacedShape> read_moveit_shapes(const ObstacleFileSpec& spec);

}  // namespace posewright
