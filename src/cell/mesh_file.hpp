#pragma once

#include <optional>

#include "posewright/cell/solid.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Files that a problem names: its packages, and the URDF that others are looked for around.
struct NamedFiles {
  NamedFiles(const Problem& problem);

  const ProblemFile& problem;
  std::filesystem::path around;  ///< empty: there is no URDF
};

/// Path of a mesh file with a name as in a URDF: package://NAME/… is searched in Problem::packages, the folders of
/// ROS_PACKAGE_PATH (AMENT_PREFIX_PATH, Gazebo's), the folders above the URDF, and those around it whose package.xml
/// has the name. Throws InputError at `place`.
std::filesystem::path find_mesh(const std::filesystem::path& name, const NamedFiles& files, const SourcePlace& place);

/// Folder or file that a world's `model://NAME…` or `package://NAME…` means; empty: not found.
std::filesystem::path find_model(const std::string& uri, const NamedFiles& files);

/// Triangles of a mesh file (.stl, .obj, .dae), scaled. Throws InputError at `place`, naming the file, if it cannot be
/// read, is too large, has no triangles, or vertices that are not finite or farther than 1000 m.
TriangleMesh read_mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale, const SourcePlace& place);

/// Triangles of a shape that has some, from its file or held by it. Throws InputError as the two above.
std::optional<TriangleMesh> mesh_of(const ShapeSpec& shape, const NamedFiles& files, const SourcePlace& place);

}  // namespace posewright
