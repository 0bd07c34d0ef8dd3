#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>

#include "own_process.hpp"
#include "triangle_files.hpp"

namespace posewright {
namespace {

TriangleMesh mesh_of(const aiScene& scene) {
  TriangleMesh mesh;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    const int first = int(mesh.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      mesh.vertices.emplace_back(v.x, v.y, v.z);
      if (!mesh.vertices.back().allFinite()) throw BadMesh("has a vertex that is not finite");
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i)
      if (const aiFace& face = part.mFaces[i]; face.mNumIndices == 3)
        mesh.triangles.push_back(
            {first + int(face.mIndices[0]), first + int(face.mIndices[1]), first + int(face.mIndices[2])});
    if (mesh.triangles.size() > most_triangles_read)
      throw BadMesh("has more than " + std::to_string(most_triangles_read) + " triangles");
  }
  return mesh;
}

TriangleMesh imported(const std::string& file) {
  Assimp::Importer importer;
  // Normals would keep the corners of triangles apart.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TEXCOORDS | aiComponent_COLORS |
                                                          aiComponent_TANGENTS_AND_BITANGENTS);
  const aiScene* scene = importer.ReadFile(file, aiProcess_RemoveComponent | aiProcess_Triangulate);
  if (scene != nullptr && scene->mRootNode != nullptr) {
    // Assimp turns Collada's z-up to y-up at the root; robots' files mean what they say. Its unit is kept.
    aiMatrix4x4& root = scene->mRootNode->mTransformation;
    const float unit = std::hypot(root.a1, root.b1, root.c1);
    aiMatrix4x4::Scaling(aiVector3D(unit, unit, unit), root);
    scene = importer.ApplyPostProcessing(aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices);
  }
  if (scene == nullptr) throw BadMesh(std::string("cannot be read: ") + importer.GetErrorString());
  return mesh_of(*scene);
}

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// Number of vertices, their coordinates, indices of the triangles' corners.
std::string packed(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.vertices.size();
  std::string bytes(sizeof vertices, '\0');
  std::memcpy(bytes.data(), &vertices, sizeof vertices);
  append(bytes, mesh.vertices);
  append(bytes, mesh.triangles);
  return bytes;
}

TriangleMesh unpacked(const std::string& bytes) {
  TriangleMesh mesh;
  std::size_t vertices = 0;
  std::memcpy(&vertices, bytes.data(), sizeof vertices);
  mesh.vertices.resize(vertices);
  const std::size_t corners = sizeof vertices + vertices * sizeof mesh.vertices[0];
  mesh.triangles.resize((bytes.size() - corners) / sizeof mesh.triangles[0]);
  const auto corners_begin = bytes.begin() + std::ptrdiff_t(corners);
  std::copy(bytes.begin() + sizeof vertices, corners_begin, reinterpret_cast<char*>(mesh.vertices.data()));
  std::copy(corners_begin, bytes.end(), reinterpret_cast<char*>(mesh.triangles.data()));
  return mesh;
}

}  // namespace

TriangleMesh read_collada(const std::string& file) {
  std::string bytes;
  try {
    bytes = in_own_process([&] { return packed(imported(file)); });
  } catch (const OwnProcessFailed& error) {
    throw BadMesh(error.what());
  }
  return unpacked(bytes);
}

}  // namespace posewright
