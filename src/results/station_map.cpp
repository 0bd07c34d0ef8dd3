#include "station_map.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include "posewright/model/placement.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;
using Points = std::vector<Eigen::Vector3d>;

// Round bodies as polygons of so many corners, whose sides the circle touches to a hundredth of its radius.
constexpr int corners_of_circle = 24;

Json point_json(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

std::optional<Placement> base_of(const RobotSpec& robot) {
  return std::visit(
      [](const auto& spec) -> std::optional<Placement> {
        if constexpr (std::is_same_v<std::decay_t<decltype(spec)>, CompensatorGeometrySpec>) return std::nullopt;
        else return spec.placement;
      },
      robot);
}

void add_circle(double radius, double z, Points& points) {
  for (int k = 0; k < corners_of_circle; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners_of_circle;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
}

/// In the body's frame.
Points outline(const ShapeSpec& shape) {
  Points points;
  if (const auto* box = std::get_if<BoxShape>(&shape)) {
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5}) points.emplace_back(box->size.cwiseProduct(Eigen::Vector3d(x, y, z)));
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    for (const double z : {-0.5, 0.5}) add_circle(cylinder->radius, z * cylinder->length, points);
  } else if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    add_circle(sphere->radius, 0, points);
  }
  return points;
}

}  // namespace

Json base_json(const Problem& problem) {
  const std::optional<Placement> base = base_of(problem.robot);
  return base ? point_json(base->position) : Json(nullptr);
}

Json obstacles_json(const Problem& problem) {
  Json list = Json::array();
  if (!problem.workspace.collision) return list;
  for (const BodySpec& body : problem.workspace.collision->obstacles) {
    if (!body.station.empty()) continue;
    // A sphere looks alike from everywhere: its outline is seen from above, however its frame is turned.
    Eigen::Isometry3d X = isometry(body.placement);
    if (std::holds_alternative<SphereShape>(body.shape)) X.linear().setIdentity();
    Json points = Json::array();
    for (const Eigen::Vector3d& p : outline(body.shape)) points.push_back(point_json(X * p));
    list.push_back({{"name", body.name}, {"points", points}});
  }
  return list;
}

}  // namespace posewright
