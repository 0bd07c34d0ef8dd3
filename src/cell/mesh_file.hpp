#pragma once

#include "posewright/cell/solid.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Where a mesh file named as in a URDF is: package://NAME/… is looked for in Problem::packages, the folders of
/// ROS_PACKAGE_PATH and the folders above the URDF. Throws InputError at `place`, with the folders tried.
std::filesystem::path find_mesh(const std::filesystem::path& name, const Problem& problem, const SourcePlace& place);

/// Triangles of a mesh file, scaled. Throws InputError at `place` where the file cannot be read, has no triangles, or
/// coordinates that are not finite.
TriangleMesh read_mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale, const SourcePlace& place);

}  // namespace posewright
