#include <array>
#include <set>

#include "posewright/support/text.hpp"
#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

ShapeSpec read_box(const Value& value) { return BoxShape{value.vector(Quantity::length, Sign::positive)}; }

ShapeSpec read_cylinder(const Value& value) {
  const Section section(value);
  section.allow({"radius", "length"});
  return CylinderShape{section.at("radius").number(Quantity::length, Sign::positive),
                       section.at("length").number(Quantity::length, Sign::positive)};
}

ShapeSpec read_sphere(const Value& value) { return SphereShape{value.number(Quantity::length, Sign::positive)}; }

ShapeSpec read_plane(const Value& value) { return HalfSpaceShape{read_direction(value)}; }

/// Shapes by their word; a new one is one row.
struct ShapeReader {
  std::string_view name;
  ShapeSpec (*read)(const Value& value);
};
constexpr std::array<ShapeReader, 4> shapes = {
    {{"box", read_box}, {"cylinder", read_cylinder}, {"sphere", read_sphere}, {"plane", read_plane}}};

ShapeSpec read_mesh(const Section& section, const Value& mesh, const std::filesystem::path& folder) {
  const std::string name = mesh.text("a file name is expected");
  MeshShape shape;
  shape.file = name.starts_with("package://") || name.starts_with("file://") ? std::filesystem::path(name)
                                                                             : mesh.base(folder) / name;
  if (const Value* scale = section.find("scale"))
    shape.scale = scale->is_list() ? scale->vector(Quantity::number, Sign::positive)
                                   : Eigen::Vector3d::Constant(scale->number(Quantity::number, Sign::positive));
  return shape;
}

BodySpec read_body(const Value& value, const std::string& name, const std::filesystem::path& folder) {
  const Section section(value);
  section.allow({"name", "box", "cylinder", "sphere", "plane", "mesh", "scale", "at", "rpy", "station", "tip"});
  BodySpec body;
  body.name = name;
  body.line = value.line();
  int found = 0;
  for (const ShapeReader& reader : shapes)
    if (const Value* shape = section.find(reader.name)) {
      body.shape = reader.read(*shape);
      ++found;
    }
  if (const Value* mesh = section.find("mesh")) {
    body.shape = read_mesh(section, *mesh, folder);
    ++found;
  } else if (const Value* scale = section.find("scale")) {
    scale->fail("needs a mesh", "only meshes are scaled");
  }
  if (found != 1) value.fail("has " + std::to_string(found) + " shapes", "one of box, cylinder, sphere, plane, mesh");
  if (const Value* given = section.find("name")) body.name = given->exact_name().value;
  if (const Value* at = section.find("at")) body.placement.position = at->vector(Quantity::length);
  if (const Value* rpy = section.find("rpy")) body.placement.rpy = rpy->vector(Quantity::angle);
  if (const Value* station = section.find("station")) body.station = station->exact_name().value;
  if (const Value* tip = section.find("tip")) body.tip = tip->exact_name();
  return body;
}

ObstacleFileSpec read_obstacle_file(const Section& section, const std::filesystem::path& folder) {
  section.allow({"file", "at", "rpy", "except"});
  ObstacleFileSpec spec;
  spec.file = section.at("file").file(folder);
  spec.line = section.at("file").line();
  if (const Value* at = section.find("at")) spec.placement.position = at->vector(Quantity::length);
  if (const Value* rpy = section.find("rpy")) spec.placement.rpy = rpy->vector(Quantity::angle);
  if (const Value* except = section.find("except")) spec.except = except->texts();
  return spec;
}

/// Shapes, and files of many.
void read_obstacles(const Value& value, const std::filesystem::path& folder, std::set<std::string>& names,
                    CollisionSpec& collision) {
  for (const Value& item : value.items("a list of shapes and files is expected")) {
    if (const Section section(item); section.has("file")) {
      collision.obstacle_files.push_back(read_obstacle_file(section, folder));
      continue;
    }
    collision.obstacles.push_back(
        read_body(item, "obstacle " + std::to_string(collision.obstacles.size() + 1), folder));
    if (collision.obstacles.back().tip) item.fail("rides on a tip", "parts of the tool do");
    if (!names.insert(collision.obstacles.back().name).second)
      item.fail("repeats the name " + in_quotes(collision.obstacles.back().name), "every name is allowed once");
  }
}

std::vector<BodySpec> read_tool(const Value& value, const std::filesystem::path& folder, std::set<std::string>& names) {
  std::vector<BodySpec> bodies;
  for (const Value& item : value.items("a list of shapes is expected")) {
    bodies.push_back(read_body(item, "tool " + std::to_string(bodies.size() + 1), folder));
    if (!names.insert(bodies.back().name).second)
      item.fail("repeats the name " + in_quotes(bodies.back().name), "every name is allowed once");
  }
  return bodies;
}

/// A length for all pairs, or {all: LENGTH, pairs: [{between: [A, B], clearance: LENGTH}]}.
void read_self_clearance(const Value& value, CollisionSpec& collision) {
  if (!value.is_mapping()) {
    collision.self_clearance = value.number(Quantity::length, Sign::not_negative);
    return;
  }
  const Section section(value);
  section.allow({"all", "pairs"});
  if (const Value* all = section.find("all"))
    collision.self_clearance = all->number(Quantity::length, Sign::not_negative);
  if (const Value* pairs = section.find("pairs"))
    for (const Value& item : pairs->items("a list of {between, clearance} is expected")) {
      const Section pair(item);
      pair.allow({"between", "clearance"});
      const std::vector<Value> names = pair.at("between").items(2, "two names are expected");
      collision.pair_clearances.push_back({names[0].exact_name(), names[1].exact_name(),
                                           pair.at("clearance").number(Quantity::length, Sign::not_negative)});
    }
}

}  // namespace

Eigen::Vector3d read_direction(const Value& value) {
  const Eigen::Vector3d direction = value.vector(Quantity::number);
  if (!(direction.norm() > 1e-9)) value.fail("is zero", "a direction is needed");
  return direction.normalized();
}

CollisionSpec read_collision(const Value& value, const std::filesystem::path& folder) {
  const Section section(value);
  section.allow({"self", "clearance", "self_clearance", "hulls", "srdf", "ignore", "tool", "obstacles"});
  CollisionSpec collision;
  collision.line = value.line();
  if (const Value* self = section.find("self")) collision.self = self->flag();
  if (const Value* hulls = section.find("hulls")) collision.hulls = hulls->flag();
  if (const Value* clearance = section.find("clearance"))
    collision.clearance = clearance->number(Quantity::length, Sign::not_negative);
  if (const Value* clearance = section.find("self_clearance")) read_self_clearance(*clearance, collision);
  if (const Value* srdf = section.find("srdf")) collision.srdf = {srdf->file(folder), srdf->line()};
  if (const Value* ignore = section.find("ignore"))
    for (const Value& pair : ignore->items("a list of pairs is expected")) {
      const std::vector<Value> names = pair.items(2, "two names are expected");
      collision.ignore.emplace_back(names[0].exact_name(), names[1].exact_name());
    }
  std::set<std::string> names;
  if (const Value* tool = section.find("tool")) {
    collision.tool = read_tool(*tool, folder, names);
    for (const BodySpec& body : collision.tool)
      if (std::holds_alternative<HalfSpaceShape>(body.shape))
        tool->fail("has a plane", "a tool has an end: box, cylinder, sphere, mesh");
  }
  if (const Value* obstacles = section.find("obstacles")) read_obstacles(*obstacles, folder, names, collision);
  return collision;
}

}  // namespace posewright
