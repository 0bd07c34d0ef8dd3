#include "../triangle_files.hpp"

namespace posewright {

// The library that reads Collada files may abort on a damaged one, and there is no process of its own for it here.
TriangleMesh read_collada(const std::string&) {
  throw BadMesh("is a Collada file, which is not in this build (WebAssembly): .stl and .obj are read");
}

}  // namespace posewright
