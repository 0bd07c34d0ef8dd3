#include "mesh_file.hpp"

#include <algorithm>
#include <cctype>

#include "posewright/problem/package_search.hpp"
#include "posewright/support/file.hpp"
#include "triangle_files.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_mesh = 300'000'000;  // bytes
constexpr double farthest = 1e3;                      // m

std::string ending_of(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return ending;
}

TriangleMesh triangles_of(const fs::path& file) {
  const std::string ending = ending_of(file);
  if (ending == ".stl") return read_stl(read_file(file, largest_mesh));
  if (ending == ".obj") return read_obj(read_file(file, largest_mesh));
  if (ending != ".dae") throw BadMesh("has an unknown format: .stl, .obj and .dae are read");
  std::error_code code;
  if (fs::file_size(file, code) > largest_mesh || code) throw BadMesh("is too large");
  record_input(file);
  return read_collada(file.string());
}

}  // namespace

NamedFiles::NamedFiles(const Problem& all) : problem(all) {
  if (const auto* arm = std::get_if<SerialArmSpec>(&all.robot)) around = arm->urdf;
}

fs::path find_mesh(const fs::path& name, const NamedFiles& files, const SourcePlace& place) {
  const fs::path file = file_of_uri(name, files.problem.packages, files.around, place);
  std::error_code code;
  if (!fs::is_regular_file(file, code))
    throw InputError(place, "mesh '" + file.string() + "' is not there", "a mesh file is needed");
  return file;
}

fs::path find_model(const std::string& uri, const NamedFiles& files) {
  return find_model(uri, files.problem.packages, files.around);
}

TriangleMesh read_mesh(const fs::path& file, const Eigen::Vector3d& scale, const SourcePlace& place) {
  const std::string named = "mesh '" + file.string() + "' ";
  TriangleMesh mesh;
  try {
    mesh = triangles_of(file);
  } catch (const BadMesh& error) {
    throw InputError(place, named + error.what(), "");
  }
  if (mesh.triangles.empty()) throw InputError(place, named + "has no triangles", "");
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = scale.cwiseProduct(vertex);
    if (!(vertex.cwiseAbs().maxCoeff() < farthest))
      throw InputError(place, named + "has a vertex farther than 1000 m", "is it in mm? scale: [0.001, 0.001, 0.001]");
  }
  return mesh;
}

std::optional<TriangleMesh> mesh_of(const ShapeSpec& shape, const NamedFiles& files, const SourcePlace& place) {
  if (const auto* held = std::get_if<std::shared_ptr<const TrianglesShape>>(&shape))
    return TriangleMesh{(*held)->vertices, (*held)->triangles};
  if (const auto* file = std::get_if<MeshShape>(&shape))
    return read_mesh(find_mesh(file->file, files, place), file->scale, place);
  return std::nullopt;
}

}  // namespace posewright
