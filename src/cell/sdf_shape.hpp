#pragma once

#include "posewright/problem/problem.hpp"
#include "sdf_element.hpp"

namespace posewright {

/// A shape where its collision is.
struct SdfShape {
  ShapeSpec shape;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
};

/// The shape of a <geometry>; of a capsule a cylinder and two spheres, of <empty/> none. A mesh that is named without
/// scheme lies beside its file. Throws InputError for kinds that are not read, a part of a mesh, and sizes that are
/// missing or not above zero.
std::vector<SdfShape> sdf_shapes(const SdfElement& geometry);

}  // namespace posewright
