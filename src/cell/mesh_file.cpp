#include "mesh_file.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdlib>

namespace posewright {
namespace {

namespace fs = std::filesystem;

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
  Assimp::Importer importer;
  // Normals would keep the corners of triangles apart.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TEXCOORDS | aiComponent_COLORS |
                                                          aiComponent_TANGENTS_AND_BITANGENTS);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_RemoveComponent | aiProcess_Triangulate);
  if (scene != nullptr && scene->mRootNode != nullptr && file.extension() == ".dae") {
    // Assimp turns Collada's z-up to y-up at the root; robots' files mean what they say. Its unit is kept.
    aiMatrix4x4& root = scene->mRootNode->mTransformation;
    const float unit = std::hypot(root.a1, root.b1, root.c1);
    aiMatrix4x4::Scaling(aiVector3D(unit, unit, unit), root);
  }
  if (scene != nullptr)
    scene = importer.ApplyPostProcessing(aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices);
  if (scene == nullptr)
    throw InputError(place, "mesh '" + file.string() + "' cannot be read: " + importer.GetErrorString(), "");
  TriangleMesh mesh;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    const int first = int(mesh.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      mesh.vertices.push_back(scale.cwiseProduct(Eigen::Vector3d(v.x, v.y, v.z)));
      if (!mesh.vertices.back().allFinite())
        throw InputError(place, "mesh '" + file.string() + "' has a vertex that is not finite", "");
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i)
      if (const aiFace& face = part.mFaces[i]; face.mNumIndices == 3)
        mesh.triangles.push_back(
            {first + int(face.mIndices[0]), first + int(face.mIndices[1]), first + int(face.mIndices[2])});
  }
  if (mesh.triangles.empty()) throw InputError(place, "mesh '" + file.string() + "' has no triangles", "");
  return mesh;
}

}  // namespace posewright
