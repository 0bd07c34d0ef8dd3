#include <array>
#include <map>
#include <set>

#include "mesh_file.hpp"
#include "obstacle_files.hpp"
#include "posewright/model/link_geometry.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/error.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

/// Solids of shapes; a mesh file is read once.
class Solids {
 public:
  Solids(const NamedFiles& files, bool hulls) : files_(files), hulls_(hulls) {}

  std::shared_ptr<const Solid> of(const ShapeSpec& shape, const SourcePlace& place) {
    const auto* file = std::get_if<MeshShape>(&shape);
    if (file == nullptr) return solid_of(shape, "the shape", place);
    const std::filesystem::path found = find_mesh(file->file, files_, place);
    const Key key{found.string(), {file->scale.x(), file->scale.y(), file->scale.z()}};
    if (const auto known = solids_.find(key); known != solids_.end()) return known->second;
    return solids_[key] = solid_of(shape, "mesh '" + found.string() + "'", place);
  }

 private:
  std::shared_ptr<const Solid> solid_of(const ShapeSpec& shape, const std::string& what, const SourcePlace& place) {
    std::optional<TriangleMesh> mesh = mesh_of(shape, files_, place);
    try {
      if (mesh && hulls_) mesh = convex_hull(*mesh);
      return make_solid(shape, mesh ? &*mesh : nullptr);
    } catch (const std::invalid_argument& error) {
      throw InputError(place, what + " is degenerate: " + error.what(), "triangles with an area are needed");
    }
  }

  NamedFiles files_;
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

void add_obstacles(const ObstacleFileSpec& spec, const NamedFiles& files, const RootPlace& cell,
                   std::vector<BodyShape>& shapes) {
  std::set<std::string> taken;
  for (const BodyShape& shape : shapes) taken.insert(shape.name);
  for (PlacedShape& placed : read_obstacle_file(spec, files)) {
    if (taken.count(placed.name) > 0)
      throw InputError(files.problem.at(spec.line),
                       "'" + spec.file.string() + "' has a body named '" + placed.name + "', as another one is",
                       "except: [" + placed.name + "], or another name");
    shapes.push_back({placed.name, "", "", BodyShape::Kind::obstacle, cell.frame,
                      cell.X_FrameRoot * isometry(spec.placement) * placed.X, std::move(placed.shape),
                      SourcePlace{spec.file.string(), placed.line}});
  }
}

}  // namespace

RootPlace cell_place(const Problem& problem) {
  const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
  if (arm == nullptr) return {};
  const RootPlace root = root_place(*arm, problem.at(arm->line));
  return root.base_moves() ? root : RootPlace{};
}

std::vector<BodyShape> list_shapes(const Problem& problem,
                                   const std::function<BodyFrames::Tip(const std::string& name)>& tip_of) {
  std::vector<BodyShape> shapes;
  std::map<int, std::string> last_links;  // by frame
  if (const auto* arm = std::get_if<SerialArmSpec>(&problem.robot))
    for (const LinkGeometry& link : read_urdf_links(*arm, problem.at(arm->line))) {
      for (const LinkShape& s : link.shapes)
        shapes.push_back({link.name, "", link.parent, BodyShape::Kind::link, link.frame, s.X_FrameShape, s.shape,
                          SourcePlace{arm->urdf.string(), link.line}, link.follower, link.colour});
      last_links[link.frame] = link.name;
    }
  if (!problem.workspace.collision) return shapes;
  for (const BodySpec& part : problem.workspace.collision->tool) {
    const BodyFrames::Tip tip = tip_of(part.tip ? part.tip->value : "");
    shapes.push_back({part.name, part.station, last_links[tip.frame], BodyShape::Kind::tool, tip.frame,
                      tip.X_FrameTip * isometry(part.placement), part.shape, problem.at(part.line)});
  }
  const RootPlace cell = cell_place(problem);
  for (const BodySpec& obstacle : problem.workspace.collision->obstacles) {
    // An instrument's own body stands where the instrument does.
    const RootPlace place = obstacle.station.empty() ? cell : RootPlace{};
    shapes.push_back({obstacle.name, obstacle.station, "", BodyShape::Kind::obstacle, place.frame,
                      place.X_FrameRoot * isometry(obstacle.placement), obstacle.shape, problem.at(obstacle.line)});
  }
  for (const ObstacleFileSpec& file : problem.workspace.collision->obstacle_files)
    add_obstacles(file, problem, cell, shapes);
  return shapes;
}

std::vector<Body> build_bodies(const Problem& problem, const BodyFrames& frames) {
  Solids solids(problem, problem.workspace.collision->hulls);
  std::vector<Body> bodies;
  for (const BodyShape& s : list_shapes(problem, [&](const std::string& name) { return frames.tip(name); })) {
    refuse_moving_branch(s);
    bodies.push_back({s.name, s.station, s.parent, s.kind == BodyShape::Kind::obstacle, s.kind == BodyShape::Kind::tool,
                      s.frame, s.X_FrameBody, solids.of(s.shape, s.place)});
  }
  return bodies;
}

}  // namespace posewright
