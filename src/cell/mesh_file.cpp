#include "mesh_file.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <set>

#include "posewright/support/file.hpp"
#include "posewright/support/trimmed.hpp"
#include "triangle_files.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_mesh = 300'000'000;  // bytes
constexpr double farthest = 1e3;                      // m
constexpr std::string_view file_scheme = "file://";
// Gazebo calls packages models.
constexpr std::array<std::string_view, 2> package_schemes{"package://", "model://"};

/// Variables that list folders, and where in those packages lie.
constexpr std::array<std::pair<const char*, const char*>, 4> folder_variables{{{"ROS_PACKAGE_PATH", ""},
                                                                               {"AMENT_PREFIX_PATH", "share"},
                                                                               {"GZ_SIM_RESOURCE_PATH", ""},
                                                                               {"GAZEBO_MODEL_PATH", ""}}};
// Packages beside the URDF's own, in the same repository or workspace.
constexpr int levels_above = 5, levels_below = 2;

std::vector<fs::path> folders_above(const Problem& problem) {
  std::vector<fs::path> folders;
  if (const auto* arm = std::get_if<SerialArmSpec>(&problem.robot)) {
    std::error_code code;
    const fs::path start = fs::absolute(arm->urdf, code).lexically_normal().parent_path();
    for (fs::path folder = start; folder.has_relative_path(); folder = folder.parent_path()) folders.push_back(folder);
  }
  return folders;
}

/// Folders in which NAME may lie: those of the environment, then those above the URDF.
std::vector<fs::path> search_folders(const Problem& problem) {
  std::vector<fs::path> folders;
  for (const auto& [variable, below] : folder_variables) {
    const char* value = std::getenv(variable);
    const std::string text = value == nullptr ? "" : value;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(':', begin), text.size());
      if (end > begin) folders.push_back(fs::path(text.substr(begin, end - begin)) / below);
      begin = end + 1;
    }
  }
  for (const fs::path& folder : folders_above(problem)) folders.push_back(folder);
  return folders;
}

/// Whether the folder's package.xml says that it is package `name`.
bool declares(const fs::path& folder, const std::string& name) {
  std::error_code code;
  if (!fs::is_regular_file(folder / "package.xml", code)) return false;
  tinyxml2::XMLDocument document;
  if (document.LoadFile((folder / "package.xml").c_str()) != tinyxml2::XML_SUCCESS) return false;
  const tinyxml2::XMLElement* root = document.FirstChildElement("package");
  const tinyxml2::XMLElement* declared = root == nullptr ? nullptr : root->FirstChildElement("name");
  return declared != nullptr && declared->GetText() != nullptr && trimmed(declared->GetText()) == name;
}

/// The folder that declares itself package `name`, this one or one below; empty: none.
fs::path declared_package(const fs::path& folder, const std::string& name, int levels) {
  if (declares(folder, name)) return folder;
  std::error_code code;
  if (levels == 0) return {};
  std::set<fs::path> below;  // in the order of their names, as folders list theirs in any
  for (fs::directory_iterator at(folder, fs::directory_options::skip_permission_denied, code), end; !code && at != end;
       at.increment(code))
    if (at->is_directory(code) && !at->is_symlink(code)) below.insert(at->path());
  for (const fs::path& child : below)
    if (const fs::path found = declared_package(child, name, levels - 1); !found.empty()) return found;
  return {};
}

fs::path find_package(const std::string& name, const Problem& problem, const SourcePlace& place) {
  for (const auto& [known, folder] : problem.packages)
    if (known == name) return folder;
  std::error_code code;
  for (const fs::path& folder : search_folders(problem)) {
    if (folder.filename() == name) return folder;
    if (fs::is_directory(folder / name, code)) return folder / name;
  }
  std::vector<fs::path> above = folders_above(problem);
  above.resize(std::min(above.size(), std::size_t(levels_above)));
  for (const fs::path& folder : above)
    if (const fs::path found = declared_package(folder, name, levels_below); !found.empty()) return found;
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
  const auto scheme = std::find_if(package_schemes.begin(), package_schemes.end(),
                                   [&](std::string_view known) { return text.starts_with(known); });
  if (scheme != package_schemes.end()) {
    text.erase(0, scheme->size());
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos || slash == 0)
      throw InputError(place, "'" + name.string() + "' names no file", std::string(*scheme) + "NAME/PATH is expected");
    file = find_package(text.substr(0, slash), problem, place) / text.substr(slash + 1);
  } else if (text.starts_with(file_scheme)) {
    file = text.substr(file_scheme.size());
  }
  std::error_code code;
  if (!fs::is_regular_file(file, code))
    throw InputError(place, "mesh '" + file.string() + "' is not there", "a mesh file is needed");
  return file;
}

fs::path find_model(const std::string& uri, const Problem& problem) {
  for (const std::string_view scheme : package_schemes) {
    if (!uri.starts_with(scheme)) continue;
    const std::string path = uri.substr(scheme.size());
    const std::size_t slash = std::min(path.find('/'), path.size());
    try {
      const fs::path folder = find_package(path.substr(0, slash), problem, {});
      return slash == path.size() ? folder : folder / path.substr(slash + 1);
    } catch (const InputError&) {
      return {};  // the caller says what is missing, and where it is named
    }
  }
  return {};
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

std::optional<TriangleMesh> mesh_of(const ShapeSpec& shape, const Problem& problem, const SourcePlace& place) {
  if (const auto* held = std::get_if<std::shared_ptr<const TrianglesShape>>(&shape))
    return TriangleMesh{(*held)->vertices, (*held)->triangles};
  if (const auto* file = std::get_if<MeshShape>(&shape))
    return read_mesh(find_mesh(file->file, problem, place), file->scale, place);
  return std::nullopt;
}

}  // namespace posewright
