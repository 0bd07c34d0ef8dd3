#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sdf/sdf.hh>

#include "mesh_file.hpp"
#include "obstacle_files.hpp"
#include "own_process.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"

namespace posewright {
namespace {

using Json = nlohmann::json;

Eigen::Isometry3d isometry_of(const ignition::math::Pose3d& pose) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() << pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z();
  X.linear() = Eigen::Quaterniond(pose.Rot().W(), pose.Rot().X(), pose.Rot().Y(), pose.Rot().Z()).normalized().matrix();
  return X;
}

Eigen::Isometry3d resolved(const sdf::SemanticPose& pose, const std::string& name) {
  ignition::math::Pose3d result;
  if (const sdf::Errors errors = pose.Resolve(result); !errors.empty())
    throw OwnProcessFailed("the pose of " + name + " cannot be found: " + errors.front().Message());
  return isometry_of(result);
}

Json numbers(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

/// What the child sends: one entry a shape, in plain numbers.
class Flattener {
 public:
  Json list = Json::array();

  void add(const sdf::Model& model, const Eigen::Isometry3d& X_WorldParent, const std::string& prefix) {
    const std::string name = prefix + model.Name();
    const Eigen::Isometry3d X = X_WorldParent * resolved(model.SemanticPose(), name);
    const bool alone = model.LinkCount() == 1 && model.ModelCount() == 0;
    for (std::uint64_t l = 0; l < model.LinkCount(); ++l) {
      const sdf::Link& link = *model.LinkByIndex(l);
      const std::string body = alone ? name : name + "::" + link.Name();
      const Eigen::Isometry3d X_WorldLink = X * resolved(link.SemanticPose(), body);
      for (std::uint64_t c = 0; c < link.CollisionCount(); ++c) add(*link.CollisionByIndex(c), X_WorldLink, body);
    }
    for (std::uint64_t m = 0; m < model.ModelCount(); ++m) add(*model.ModelByIndex(m), X, name + "::");
  }

 private:
  void add(const sdf::Collision& collision, const Eigen::Isometry3d& X_WorldLink, const std::string& body) {
    const Eigen::Isometry3d X = X_WorldLink * resolved(collision.SemanticPose(), body);
    const sdf::Geometry& geometry = *collision.Geom();
    if (const auto* box = geometry.BoxShape()) add("box", numbers(box->Size()), X, body, collision);
    else if (const auto* cylinder = geometry.CylinderShape())
      add("cylinder", {cylinder->Radius(), cylinder->Length()}, X, body, collision);
    else if (const auto* sphere = geometry.SphereShape()) add("sphere", {sphere->Radius()}, X, body, collision);
    else if (const auto* plane = geometry.PlaneShape()) add("plane", numbers(plane->Normal()), X, body, collision);
    else if (const auto* capsule = geometry.CapsuleShape()) add_capsule(*capsule, X, body, collision);
    else if (const auto* mesh = geometry.MeshShape(); mesh != nullptr && mesh->Submesh().empty()) {
      add("mesh", numbers(mesh->Scale()), X, body, collision);
      list.back()["uri"] = mesh->Uri();
      list.back()["file"] = mesh->FilePath();
    } else {
      throw OwnProcessFailed("'" + body + "' has a shape of a kind that is not read: box, cylinder, sphere, capsule, " +
                             "plane and whole meshes are");
    }
  }

  void add_capsule(const sdf::Capsule& capsule, const Eigen::Isometry3d& X, const std::string& body,
                   const sdf::Collision& collision) {
    add("cylinder", {capsule.Radius(), capsule.Length()}, X, body, collision);
    for (const double end : {-0.5, 0.5})
      add("sphere", {capsule.Radius()}, X * Eigen::Translation3d(0, 0, end * capsule.Length()), body, collision);
  }

  void add(const char* kind, Json values, const Eigen::Isometry3d& X, const std::string& body,
           const sdf::Collision& collision) {
    Json place = Json::array();
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) place.push_back(X(row, column));
    const auto line = collision.Element() == nullptr ? std::nullopt : collision.Element()->LineNumber();
    list.push_back(
        {{"kind", kind}, {"values", std::move(values)}, {"name", body}, {"X", place}, {"line", line.value_or(0)}});
  }
};

bool is_left_out(const ObstacleFileSpec& spec, const std::string& name) {
  return std::any_of(spec.except.begin(), spec.except.end(), [&](const auto& e) { return e.value == name; });
}

/// Includes of models that are left out need not be found.
bool is_forgiven(const sdf::Error& error, const ObstacleFileSpec& spec) {
  if (error.Code() != sdf::ErrorCode::URI_LOOKUP) return false;
  return std::any_of(spec.except.begin(), spec.except.end(),
                     [&](const auto& e) { return error.Message().find("model://" + e.value) != std::string::npos; });
}

std::string flattened(const ObstacleFileSpec& spec, const Problem& problem) {
  // The library keeps a log in the user's home otherwise.
  ::setenv("HOME", "/nonexistent", 1);
  sdf::Console::Instance()->SetQuiet(true);
  sdf::ParserConfig config;
  config.SetFindCallback([&](const std::string& uri) { return find_model(uri, problem).string(); });
  sdf::Root root;
  for (const sdf::Error& error : root.Load(spec.file.string(), config)) {
    if (is_forgiven(error, spec)) continue;
    const std::string line = error.LineNumber() ? "line " + std::to_string(*error.LineNumber()) + ": " : "";
    throw OwnProcessFailed("is not read: " + line + error.Message());
  }
  Flattener flat;
  const auto add = [&](const sdf::Model& model) {
    if (!is_left_out(spec, model.Name())) flat.add(model, Eigen::Isometry3d::Identity(), "");
  };
  if (root.Model() != nullptr) add(*root.Model());
  for (std::uint64_t w = 0; w < root.WorldCount(); ++w)
    for (std::uint64_t m = 0; m < root.WorldByIndex(w)->ModelCount(); ++m) add(*root.WorldByIndex(w)->ModelByIndex(m));
  return flat.list.dump();
}

ShapeSpec shape_of(const Json& entry, const std::filesystem::path& folder) {
  const std::string kind = entry.at("kind");
  const auto v = entry.at("values").get<std::vector<double>>();
  if (kind == "cylinder") return CylinderShape{v[0], v[1]};
  if (kind == "sphere") return SphereShape{v[0]};
  const Eigen::Vector3d vector(v[0], v[1], v[2]);
  if (kind == "box") return BoxShape{vector};
  if (kind == "plane") return HalfSpaceShape{vector.normalized()};
  const std::string uri = entry.at("uri"), file = entry.at("file");
  if (uri.find("://") != std::string::npos) return MeshShape{uri, vector};
  return MeshShape{(file.empty() ? folder : std::filesystem::path(file).parent_path()) / uri, vector};
}

}  // namespace

std::vector<PlacedShape> read_sdf_shapes(const ObstacleFileSpec& spec, const Problem& problem) {
  record_input(spec.file);
  Json list;
  try {
    list = Json::parse(in_own_process([&] { return flattened(spec, problem); }));
  } catch (const OwnProcessFailed& error) {
    throw InputError({spec.file.string(), 0}, error.what(),
                     "an SDF file is needed, and the models it includes: --package NAME=FOLDER, except: [NAME]");
  }
  std::vector<PlacedShape> shapes;
  for (const Json& entry : list) {
    PlacedShape placed{entry.at("name"), shape_of(entry, spec.file.parent_path()), {}, entry.at("line")};
    const auto x = entry.at("X").get<std::vector<double>>();
    placed.X = Eigen::Isometry3d::Identity();
    placed.X.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4>>(x.data());
    shapes.push_back(std::move(placed));
  }
  return shapes;
}

}  // namespace posewright
