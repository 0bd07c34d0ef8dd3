#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "posewright/blocks/parameter.hpp"

namespace posewright {

/// Nominal pose of a frame that the problem puts at X: displaced by NAME.{x, y, z} and
/// NAME.{rx, ry, rz} in its own axes. X where the catalogue has no such parameters.
Eigen::Isometry3d nominal_placement(const std::vector<Parameter>& parameters, const std::string& name,
                                    const Eigen::Isometry3d& X);

/// Variant for a point, whose parameters NAME.{x, y, z} are its coordinates.
Eigen::Vector3d nominal_position(const std::vector<Parameter>& parameters, const std::string& name,
                                 const Eigen::Vector3d& p);

}  // namespace posewright
