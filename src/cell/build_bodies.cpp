#include <array>
#include <map>

#include "mesh_file.hpp"
#include "posewright/model/link_geometry.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/error.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

/// Solids of shapes; a mesh file is read once.
class Solids {
 public:
  Solids(const Problem& problem, bool hulls) : problem_(problem), hulls_(hulls) {}

  std::shared_ptr<const Solid> of(const ShapeSpec& shape, const SourcePlace& place) {
    const auto* file = std::get_if<MeshShape>(&shape);
    if (file == nullptr) return make_solid(shape, nullptr);
    const std::filesystem::path found = find_mesh(file->file, problem_, place);
    const Key key{found.string(), {file->scale.x(), file->scale.y(), file->scale.z()}};
    if (const auto known = solids_.find(key); known != solids_.end()) return known->second;
    try {
      TriangleMesh mesh = read_mesh(found, file->scale, place);
      if (hulls_) mesh = convex_hull(mesh);
      return solids_[key] = make_solid(shape, &mesh);
    } catch (const std::invalid_argument& error) {
      throw InputError(place, "mesh '" + found.string() + "' is degenerate: " + error.what(),
                       "triangles with an area are needed");
    }
  }

 private:
  const Problem& problem_;
  bool hulls_;
  using Key = std::pair<std::string, std::array<double, 3>>;
  std::map<Key, std::shared_ptr<const Solid>> solids_;
};

}  // namespace

std::vector<Body> build_bodies(const Problem& problem, const BodyFrames& frames) {
  const CollisionSpec& spec = *problem.workspace.collision;
  Solids solids(problem, spec.hulls);
  std::vector<Body> bodies;
  std::string last_link;
  if (const auto* arm = std::get_if<SerialArmSpec>(&problem.robot))
    for (const LinkGeometry& link : read_urdf_links(*arm, problem.at(arm->line))) {
      const SourcePlace place{arm->urdf.string(), link.line};
      for (const LinkShape& shape : link.shapes)
        bodies.push_back(
            {link.name, "", link.parent, false, link.frame, shape.X_FrameShape, solids.of(shape.shape, place)});
      if (link.frame == frames.tip_frame()) last_link = link.name;
    }
  for (const BodySpec& part : spec.tool)
    bodies.push_back({part.name, part.station, last_link, false, frames.tip_frame(),
                      frames.X_FrameTip() * isometry(part.placement), solids.of(part.shape, problem.at(part.line))});
  for (const BodySpec& obstacle : spec.obstacles)
    bodies.push_back({obstacle.name, obstacle.station, "", true, 0, isometry(obstacle.placement),
                      solids.of(obstacle.shape, problem.at(obstacle.line))});
  return bodies;
}

}  // namespace posewright
