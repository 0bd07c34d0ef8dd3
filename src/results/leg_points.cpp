#include <algorithm>
#include <optional>

#include "calibration_parts.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

struct PointCoordinate {
  std::string point;
  std::size_t axis = 0;
};

/// The point a of a leg on the base or b on the platform that a parameter is a coordinate of: "leg_3.bx".
std::optional<PointCoordinate> point_coordinate(const std::string& name) {
  const std::size_t dot = name.find('.');
  if (!name.starts_with("leg_") || dot == std::string::npos || name.size() != dot + 3) return std::nullopt;
  const std::size_t axis = std::string("xyz").find(name.back());
  if (axis == std::string::npos || (name[dot + 1] != 'a' && name[dot + 1] != 'b')) return std::nullopt;
  return PointCoordinate{name.substr(0, dot + 2), axis};
}

Json new_point(const std::string& name) {
  // A planar robot's points have no third parameter.
  return {{"name", name},
          {"nominal", {0.0, 0.0, 0.0}},
          {"calibrated", {0.0, 0.0, 0.0}},
          {"sigma", {nullptr, nullptr, nullptr}}};
}

}  // namespace

Json leg_points_json(const Calibration& c) {
  Json points = Json::array();
  for (const EstimatedValue& estimated : c.values) {
    const auto at = point_coordinate(estimated.value.name);
    if (!at) continue;
    auto point = std::find_if(points.begin(), points.end(), [&](const Json& p) { return p["name"] == at->point; });
    if (point == points.end()) {
      points.push_back(new_point(at->point));
      point = points.end() - 1;
    }
    (*point)["nominal"][at->axis] = estimated.value.nominal;
    (*point)["calibrated"][at->axis] = estimated.value.value;
    if (estimated.sigma) (*point)["sigma"][at->axis] = *estimated.sigma;
  }
  return points;
}

}  // namespace posewright
