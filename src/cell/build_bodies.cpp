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

/// A rod or a finger that moves with the arm cannot be checked where it hangs at zero.
void refuse_moving_branch(const BodyShape& shape) {
  if (!shape.follower.empty())
    throw InputError(shape.place,
                     "link '" + shape.name + "' is moved by joint '" + shape.follower +
                         "', which follows the chain from a branch; such shapes are not checked for collision yet",
                     "remove its <collision>, or choose a tip whose chain has the joint");
}

}  // namespace

std::vector<BodyShape> list_shapes(const Problem& problem, int tip_frame, const Eigen::Isometry3d& X_FrameTip) {
  std::vector<BodyShape> shapes;
  std::string last_link;
  if (const auto* arm = std::get_if<SerialArmSpec>(&problem.robot))
    for (const LinkGeometry& link : read_urdf_links(*arm, problem.at(arm->line))) {
      for (const LinkShape& s : link.shapes)
        shapes.push_back({link.name, "", link.parent, BodyShape::Kind::link, link.frame, s.X_FrameShape, s.shape,
                          SourcePlace{arm->urdf.string(), link.line}, link.follower});
      if (link.frame == tip_frame) last_link = link.name;
    }
  if (!problem.workspace.collision) return shapes;
  for (const BodySpec& part : problem.workspace.collision->tool)
    shapes.push_back({part.name, part.station, last_link, BodyShape::Kind::tool, tip_frame,
                      X_FrameTip * isometry(part.placement), part.shape, problem.at(part.line)});
  for (const BodySpec& obstacle : problem.workspace.collision->obstacles)
    shapes.push_back({obstacle.name, obstacle.station, "", BodyShape::Kind::obstacle, 0, isometry(obstacle.placement),
                      obstacle.shape, problem.at(obstacle.line)});
  return shapes;
}

std::vector<Body> build_bodies(const Problem& problem, const BodyFrames& frames) {
  Solids solids(problem, problem.workspace.collision->hulls);
  std::vector<Body> bodies;
  for (const BodyShape& s : list_shapes(problem, frames.tip_frame(), frames.X_FrameTip())) {
    refuse_moving_branch(s);
    bodies.push_back({s.name, s.station, s.parent, s.kind == BodyShape::Kind::obstacle, s.kind == BodyShape::Kind::tool,
                      s.frame, s.X_FrameBody, solids.of(s.shape, s.place)});
  }
  return bodies;
}

}  // namespace posewright
