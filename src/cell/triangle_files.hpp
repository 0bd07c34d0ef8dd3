#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "posewright/cell/solid.hpp"

namespace posewright {

/// Error of a mesh; the caller knows its name.
class BadMesh : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// More than any link of a robot has; a damaged or malicious file may claim anything.
inline constexpr std::size_t most_triangles_read = 5'000'000;

/// Triangles of an STL file, binary or text; corners at the same place are one vertex. Throws BadMesh.
TriangleMesh read_stl(std::string_view bytes);

/// Triangles of a Wavefront OBJ file: `v` and `f`, polygons as fans from their first corner; groups, normals, textures
/// and materials are passed over. Throws BadMesh.
TriangleMesh read_obj(std::string_view text);

/// Triangles of a Collada file by assimp, in a process of its own that may take so much memory and time and no more:
/// damaged files make the library abort or fill the memory. Scaled to metres as the file says, its axes as they are.
/// Throws BadMesh.
TriangleMesh read_collada(const std::string& file);

}  // namespace posewright
