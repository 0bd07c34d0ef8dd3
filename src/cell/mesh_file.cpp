#include "mesh_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "posewright/support/file.hpp"
#include "triangle_files.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_mesh = 300'000'000;  // bytes
constexpr double farthest = 1e3;                      // m
constexpr std::string_view package_scheme = "package://", file_scheme = "file://";

/// Folders in which NAME may lie: those of ROS_PACKAGE_PATH, then those above the URDF.
std::vector<fs::path> search_folders(const Problem& problem) {
  std::vector<fs::path> folders;
  if (const char* variable = std::getenv("ROS_PACKAGE_PATH")) {
    const std::string text = variable;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(':', begin), text.size());
      if (end > begin) folders.emplace_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  if (const auto* arm = std::get_if<SerialArmSpec>(&problem.robot)) {
    std::error_code code;
    const fs::path start = fs::absolute(arm->urdf, code).lexically_normal().parent_path();
    for (fs::path folder = start; folder.has_relative_path(); folder = folder.parent_path()) folders.push_back(folder);
  }
  return folders;
}

fs::path find_package(const std::string& name, const Problem& problem, const SourcePlace& place) {
  for (const auto& [known, folder] : problem.packages)
    if (known == name) return folder;
  std::error_code code;
  for (const fs::path& folder : search_folders(problem)) {
    if (folder.filename() == name) return folder;
    if (fs::is_directory(folder / name, code)) return folder / name;
  }
  throw InputError(place, "package '" + name + "' is not found",
                   "name its folder with --package " + name + "=FOLDER or in ROS_PACKAGE_PATH");
}

std::string ending_of(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return ending;
}

TriangleMesh triangles_of(const fs::path& file) {
  const std::string ending = ending_of(file);
  if (ending == ".stl") return read_stl(read_file(file, largest_mesh));
  if (ending == ".obj") return read_obj(read_file(file, largest_mesh));
  if (ending != ".dae") throw BadMesh("is of a kind that is not read: .stl, .obj and .dae are");
  std::error_code code;
  if (fs::file_size(file, code) > largest_mesh || code) throw BadMesh("is too large");
  record_input(file);
  return read_collada(file.string());
}

}  // namespace

fs::path find_mesh(const fs::path& name, const Problem& problem, const SourcePlace& place) {
  std::string text = name.string();
  fs::path file = name;
  if (text.starts_with(package_scheme)) {
    text.erase(0, package_scheme.size());
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos || slash == 0)
      throw InputError(place, "'" + name.string() + "' names no file", "package://NAME/PATH is expected");
    file = find_package(text.substr(0, slash), problem, place) / text.substr(slash + 1);
  } else if (text.starts_with(file_scheme)) {
    file = text.substr(file_scheme.size());
  }
  std::error_code code;
  if (!fs::is_regular_file(file, code))
    throw InputError(place, "mesh '" + file.string() + "' is not there", "a mesh file is needed");
  return file;
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

}  // namespace posewright
