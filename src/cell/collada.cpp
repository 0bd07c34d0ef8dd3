#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>

#include "triangle_files.hpp"

namespace posewright {
namespace {

constexpr rlim_t most_bytes = rlim_t(1) << 30;  // beyond what the process has when it begins
constexpr rlim_t most_seconds = 60;
constexpr std::size_t longest_message = 300;

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

/// Address space of this process so far, bytes.
rlim_t present_size() {
  std::ifstream status("/proc/self/statm");
  unsigned long pages = 0;
  status >> pages;
  return rlim_t(pages) * rlim_t(::sysconf(_SC_PAGESIZE));
}

void send(int to, const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(to, bytes, size);
    if (n <= 0 && errno != EINTR) ::_exit(1);
    if (n > 0) bytes += n, size -= std::size_t(n);
  }
}

/// What the child does: 'm', counts, numbers; or 'e' and what is wrong.
[[noreturn]] void import_and_send(const std::string& file, int to) {
  const rlimit memory{present_size() + most_bytes, present_size() + most_bytes}, time{most_seconds, most_seconds},
      none{0, 0};
  ::setrlimit(RLIMIT_AS, &memory);
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_CORE, &none);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  std::string problem;
  try {
    const TriangleMesh mesh = imported(file);
    const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
    send(to, "m", 1);
    send(to, &vertices, sizeof vertices);
    send(to, &triangles, sizeof triangles);
    send(to, mesh.vertices.data(), vertices * sizeof mesh.vertices[0]);
    send(to, mesh.triangles.data(), triangles * sizeof mesh.triangles[0]);
    ::_exit(0);
  } catch (const std::bad_alloc&) {
    problem = "takes more memory than a mesh may";
  } catch (const std::exception& error) {
    problem = std::string(error.what()).substr(0, longest_message);
  }
  send(to, "e", 1);
  send(to, problem.data(), problem.size());
  ::_exit(0);
}

bool receive(int from, void* data, std::size_t size) {
  char* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t n = ::read(from, bytes, size);
    if (n == 0 || (n < 0 && errno != EINTR)) return false;
    if (n > 0) bytes += n, size -= std::size_t(n);
  }
  return true;
}

/// Throws BadMesh for what the child says is wrong, and if it ended without a word.
TriangleMesh received(int from) {
  TriangleMesh mesh;
  char kind = 0;
  if (!receive(from, &kind, 1)) throw BadMesh("cannot be read: it is damaged, or takes too much memory or time");
  if (kind == 'e') {
    std::string problem(longest_message, '\0');
    std::size_t length = 0;
    while (length < problem.size() && receive(from, problem.data() + length, 1)) ++length;
    throw BadMesh(problem.substr(0, length));
  }
  std::size_t vertices = 0, triangles = 0;
  if (!receive(from, &vertices, sizeof vertices) || !receive(from, &triangles, sizeof triangles))
    throw BadMesh("cannot be read");
  mesh.vertices.resize(vertices);
  mesh.triangles.resize(triangles);
  if (!receive(from, mesh.vertices.data(), vertices * sizeof mesh.vertices[0]) ||
      !receive(from, mesh.triangles.data(), triangles * sizeof mesh.triangles[0]))
    throw BadMesh("cannot be read to its end");
  return mesh;
}

}  // namespace

TriangleMesh read_collada(const std::string& file) {
  int ends[2];  // NOLINT(modernize-avoid-c-arrays): pipe() takes nothing else
  if (::pipe(ends) != 0) throw BadMesh(std::string("cannot be read: ") + std::strerror(errno));
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    import_and_send(file, ends[1]);
  }
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    throw BadMesh(std::string("cannot be read: ") + std::strerror(errno));
  }
  const auto finish = [&] {
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  };
  try {
    TriangleMesh mesh = received(ends[0]);
    finish();
    return mesh;
  } catch (...) {
    finish();
    throw;
  }
}

}  // namespace posewright
