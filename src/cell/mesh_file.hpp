#pragma once

#include "posewright/cell/solid.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Where a mesh file named as in a URDF is: package://NAME/… is looked for in Problem::packages, the folders of
/// ROS_PACKAGE_PATH and the folders above the URDF. Throws InputError at `place`, with the folders tried.
std::filesystem::path find_mesh(const std::filesystem::path& name, const Problem& problem, const SourcePlace& place);

/// Triangles of a mesh file (.stl, .obj, .dae), scaled. Throws InputError at `place`, naming the file, if it cannot be
/// read, is too large, has no triangles, or vertices that are not finite or farther than 1000 m.
TriangleMesh read_mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale, const SourcePlace& place);

}  // namespace posewright
