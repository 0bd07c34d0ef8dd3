#include "sdf_shape.hpp"

#include <array>
#include <string_view>

#include "posewright/support/text.hpp"

namespace posewright {
namespace {

Eigen::Vector3d vector_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

std::vector<SdfShape> box(const SdfElement& e) { return {{BoxShape{vector_of(e.lengths_of("size", 3))}}}; }

std::vector<SdfShape> cylinder(const SdfElement& e) {
  return {{CylinderShape{e.lengths_of("radius", 1)[0], e.lengths_of("length", 1)[0]}}};
}

std::vector<SdfShape> sphere(const SdfElement& e) { return {{SphereShape{e.lengths_of("radius", 1)[0]}}}; }

std::vector<SdfShape> capsule(const SdfElement& e) {
  std::vector<SdfShape> shapes = cylinder(e);
  const CylinderShape body = std::get<CylinderShape>(shapes.front().shape);
  for (const double end : {-0.5, 0.5})
    shapes.push_back({SphereShape{body.radius}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, end * body.length))});
  return shapes;
}

std::vector<SdfShape> plane(const SdfElement& e) {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  if (e.child("normal")) normal = vector_of(e.numbers_of("normal", 3));
  if (!(normal.norm() > 1e-9)) e.fail("<normal> is zero", "a direction is needed");
  return {{HalfSpaceShape{normal.normalized()}}};
}

std::vector<SdfShape> mesh(const SdfElement& e) {
  const std::string uri = e.text_of("uri");
  if (uri.empty()) e.fail("<mesh> has no <uri>", "a mesh file is needed");
  if (e.child("submesh")) e.fail("has a part of a mesh", "whole meshes are read");
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  if (e.child("scale")) scale = vector_of(e.numbers_of("scale", 3));
  const bool elsewhere = uri.find("://") != std::string::npos;
  return {{MeshShape{elsewhere ? std::filesystem::path(uri) : e.file().parent_path() / uri, scale}}};
}

struct ShapeReader {
  std::string_view tag;
  std::vector<SdfShape> (*read)(const SdfElement& element);
};
constexpr std::array<ShapeReader, 7> shape_readers{{
    {"box", box},
    {"cylinder", cylinder},
    {"sphere", sphere},
    {"capsule", capsule},
    {"plane", plane},
    {"mesh", mesh},
    {"empty", [](const SdfElement&) { return std::vector<SdfShape>(); }},
}};

}  // namespace

std::vector<SdfShape> sdf_shapes(const SdfElement& geometry) {
  for (const SdfElement& element : geometry.children())
    for (const ShapeReader& reader : shape_readers)
      if (element.tag() == reader.tag) return reader.read(element);
  const std::vector<SdfElement> others = geometry.children();
  geometry.fail(others.empty() ? "<geometry> is empty" : "has a shape of the kind " + in_quotes(others.front().tag()),
                "box, cylinder, sphere, capsule, plane and whole meshes are read; except: [MODEL] leaves a model out");
}

}  // namespace posewright
