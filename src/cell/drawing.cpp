#include "posewright/cell/drawing.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "mesh_file.hpp"
#include "posewright/model/link_geometry.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/nominal_placement.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/model/urdf_ways.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/support/error.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

// A picture needs no more, and a report stays small: of one mesh, and of all.
constexpr std::size_t most_triangles = 3000, most_of_all = 30000;
// Cells along the longest edge of the box around a mesh, for the first attempt.
constexpr int finest_grid = 64;

/// Shapes of the robot's links as they look, where all of a link can be drawn; others as they are checked.
std::vector<BodyShape> looks(const Problem& problem, std::vector<BodyShape> checked) {
  const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
  if (arm == nullptr) return checked;
  std::vector<BodyShape> shapes;
  std::set<std::string> seen;
  for (const LinkGeometry& link : read_urdf_visuals(*arm, problem.at(arm->line))) {
    std::vector<BodyShape> own;
    try {
      for (const LinkShape& s : link.shapes) {
        const SourcePlace place{arm->urdf.string(), link.line};
        ShapeSpec shape = s.shape;
        if (const std::optional<TriangleMesh> mesh = mesh_of(shape, problem, place)) {
          const TriangleMesh thin = thinned(*mesh, most_triangles);
          shape = std::make_shared<const TrianglesShape>(TrianglesShape{thin.vertices, thin.triangles});
        }
        own.push_back({link.name, "", "", BodyShape::Kind::link, link.frame, s.X_FrameShape, std::move(shape), place,
                       link.follower, link.colour});
      }
    } catch (const InputError&) {
      continue;  // no picture is worth an error: the shapes that are checked will do
    }
    seen.insert(link.name);
    shapes.insert(shapes.end(), own.begin(), own.end());
  }
  for (BodyShape& s : checked)
    if (s.kind != BodyShape::Kind::link || seen.count(s.name) == 0) shapes.push_back(std::move(s));
  return shapes;
}

const char* kind_name(BodyShape::Kind kind) {
  if (kind == BodyShape::Kind::tool) return "tool";
  return kind == BodyShape::Kind::obstacle ? "obstacle" : "robot";
}

TriangleMesh on_grid(const TriangleMesh& mesh, const Eigen::Vector3d& corner, double cell) {
  TriangleMesh result;
  std::map<std::array<long, 3>, int> cells;
  std::vector<int> place;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const Eigen::Vector3d at = (v - corner) / cell;
    const std::array<long, 3> key = {std::lround(at.x()), std::lround(at.y()), std::lround(at.z())};
    const auto [entry, is_new] = cells.try_emplace(key, int(result.vertices.size()));
    if (is_new) result.vertices.push_back(v);
    place.push_back(entry->second);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<int, 3> t = {place[std::size_t(a)], place[std::size_t(b)], place[std::size_t(c)]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.triangles.push_back(t);
  }
  return result;
}

}  // namespace

TriangleMesh thinned(const TriangleMesh& mesh, std::size_t triangles) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  TriangleMesh result = mesh;
  for (double grid = finest_grid; result.triangles.size() > triangles && grid > 2; grid *= 0.75)
    result = on_grid(mesh, box.min(), box.sizes().maxCoeff() / grid);
  return result;
}

Drawing::Drawing(const Problem& problem, const Cell& cell)
    : model_(cell.model), cell_(cell_place(problem)), frame_names_{"measurement"} {
  const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
  if (arm != nullptr && !arm->ways.empty()) {
    const UrdfFrames tree = read_urdf_frames(*arm, problem.at(arm->line));
    robot_ = tree.robot;
    for (const ChainJoint& joint : tree.joints) frame_names_.push_back(joint.name);
    arm_ = make_body_frames(problem, *model_);
    for (const MeasurementSpec& instrument : *instruments_of(problem.measurement))
      tips_.push_back(instrument.of->value);
  } else if (arm != nullptr) {
    const ChainDescription chain = read_urdf_chain(*arm, problem.at(arm->line));
    robot_ = chain.robot;
    base_ = chain.X_MeasureBase.translation();
    for (const ChainJoint& joint : chain.joints) frame_names_.push_back(joint.name);
    arm_ = make_body_frames(problem, *model_);
  } else {
    tip_ = make_tip({problem, find_variant(problem, "")});
    if (tip_ != nullptr) frame_names_.emplace_back("platform");
  }
  add_bodies(problem);
  if (const std::vector<MeasurementSpec>* list = instruments_of(problem.measurement)) {
    for (std::size_t k = 0; k < list->size(); ++k) {
      instruments_.push_back((*list)[k].name);
      readers_.push_back({(*list)[k].name});
      if (const std::vector<MeasurementSpec>* members = members_of((*list)[k]))
        for (const MeasurementSpec& member : *members) readers_.back().insert(member.name);
      add_instrument((*list)[k], int(k));
    }
    for (DrawnCamera& camera : cameras_)
      for (std::size_t k = 0; k < instruments_.size(); ++k)
        if (instruments_[k] != camera.instrument && readers_[k].contains(camera.instrument))
          camera.with.push_back(instruments_[k]);
    return;
  }
  add_instrument(problem.measurement, 0);
  const LineOfSight* sight = cell.sight();
  if (sight == nullptr || sight->rides_on_tip()) return;
  for (std::size_t s = 0; s < sight->stations().size(); ++s)
    stations_.push_back({"", sight->stations()[s], sight->X_MeasureStation({}, int(s))});
}

Drawing::~Drawing() = default;

void Drawing::add_bodies(const Problem& problem) {
  if (arm_ == nullptr && tip_ == nullptr) return;
  const auto tip_of = [this](const std::string& name) {
    return arm_ != nullptr ? arm_->tip(name) : BodyFrames::Tip{int(frame_names_.size()) - 1};
  };
  for (const BodyShape& s : looks(problem, list_shapes(problem, tip_of))) {
    DrawnBody body{s.name, kind_name(s.kind), s.frame, s.X_FrameBody, s.shape, s.colour, {}};
    try {
      if (const std::optional<TriangleMesh> mesh = mesh_of(s.shape, problem, s.place)) {
        body.mesh = thinned(*mesh, most_triangles);
        body.shape = MeshShape{};
      }
    } catch (const InputError& error) {
      if (warning_.empty()) warning_ = std::string("some shapes are not drawn: ") + error.what();
      continue;
    }
    bodies_.push_back(std::move(body));
  }
  keep_to_budget();
}

void Drawing::keep_to_budget() {
  std::size_t all = 0;
  for (const DrawnBody& body : bodies_) all += body.mesh.triangles.size();
  if (all <= most_of_all) return;
  const double share = double(most_of_all) / double(all);
  for (DrawnBody& body : bodies_)
    body.mesh = thinned(body.mesh, std::size_t(share * double(body.mesh.triangles.size())));
}

Carried Drawing::carried(const MeasurementSpec& measurement, bool on_tip, const std::string& parameters,
                         const Placement& placement) const {
  BodyFrames::Tip carrier;
  if (arm_ == nullptr) carrier.frame = on_tip ? int(frame_names_.size()) - 1 : 0;
  else if (on_tip) carrier = arm_->tip(measurement.of ? measurement.of->value : "");
  else carrier = arm_->measurement_frame(measurement.in ? measurement.in->value : "");
  return {carrier.frame, carrier.X_FrameTip * nominal_placement(model_->parameters(), parameters, isometry(placement))};
}

void Drawing::add_camera(const MeasurementSpec& measurement, const InstrumentView& view) {
  const InstrumentView::Place& place = view.places.front();
  DrawnCamera camera;
  camera.instrument = measurement.name;
  camera.camera = carried(measurement, view.places_on_tip, place.parameters, place.station.placement);
  camera.board = carried(measurement, view.points_on_tip, view.points_parameters, view.points_at);
  camera.image = *view.image;
  for (const InstrumentView::Point& point : view.points) camera.points.emplace_back(point.name, point.position);
  cameras_.push_back(std::move(camera));
}

void Drawing::add_instrument(const MeasurementSpec& measurement, int index) {
  const InstrumentView view = view_of(measurement);
  const std::string& name = measurement.name;
  for (const TargetSpec& target : view.targets) {
    target_names_.push_back(name.empty() ? target.name : name + "." + target.name);
    targets_.emplace_back(index, target.position);
  }
  if (view.image && !view.places.empty() && frame_names_.size() > 1) add_camera(measurement, view);
  // Of one alone they stand in the cell's lines of sight; and a camera is drawn as one.
  if (name.empty() || view.image || view.places_on_tip || measurement.in) return;
  for (const InstrumentView::Place& place : view.places) {
    const Carried station = carried(measurement, false, place.parameters, place.station.placement);
    if (station.frame == 0) stations_.push_back({name, place.station.name, station.X_FrameThing});
  }
}

DrawnPose Drawing::at(std::span<const double> q) const {
  DrawnPose pose;
  const std::size_t reader = instruments_.empty() ? 0 : std::size_t(q.back());
  if (!instruments_.empty()) pose.instrument = instruments_[reader];
  if (arm_ != nullptr) {
    pose.frames.resize(std::size_t(arm_->count()));
    arm_->poses(q, 0, pose.frames);
    const auto placed = [&](const BodyFrames::Tip& tip) {
      return pose.frames[std::size_t(tip.frame)] * tip.X_FrameTip;
    };
    pose.tip = placed(arm_->tip(tips_.empty() ? "" : tips_[reader]));
    for (const BodyFrames::Branch& branch : arm_->branches()) {
      Polyline line = {base_};
      for (const int k : branch.frames) line.push_back(pose.frames[std::size_t(k)].translation());
      line.push_back(placed(branch.tip).translation());
      pose.lines.push_back(std::move(line));
    }
  } else if (tip_ != nullptr) {
    pose.tip = model_->tool_pose(q);
    pose.frames = {Eigen::Isometry3d::Identity(), pose.tip};
    pose.lines = tip_->skeleton(q.first(tip_->coordinates().size()));
  }
  for (const auto& [instrument, target] : targets_) {
    const bool reads = instruments_.empty() || readers_[reader].contains(instruments_[std::size_t(instrument)]);
    const bool drawn = reads && !pose.frames.empty();
    pose.targets.push_back(drawn ? std::optional<Eigen::Vector3d>(pose.tip * target) : std::nullopt);
  }
  return pose;
}

}  // namespace posewright
