#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "calibration_parts.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

/// Quaternion of a rotation with qw ≥ 0.
Eigen::Quaterniond quaternion_of(const Eigen::Isometry3d& X) {
  Eigen::Quaterniond q(X.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

/// True if the readings put the frame there.
std::string remark_of(const Calibration& c, const PlacedFrame& frame) {
  bool estimated = false;
  const std::string parameters = (frame.moved_by.empty() ? frame.name : frame.moved_by) + ".";
  for (const CalibratedParameter& p : c.parameters) {
    if (!p.estimated || !p.label.name.starts_with(parameters)) continue;
    if (!p.given.empty()) return fmt::format("given {}", fmt::join(p.given, ", "));
    estimated = true;
  }
  return estimated ? "estimated" : "not estimated";
}

/// Without the sign of a number that is shown as zero.
std::string fixed(double value) {
  constexpr double digits = 1e4;
  return fmt::format("{:.4f}", std::round(value * digits) / digits + 0.0);
}

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

std::string frames_text(const Calibration& c) {
  if (c.frames.empty()) return "";
  Table table({"frame", "key in the file", "in the frame of", "x [mm]", "y", "z", "roll [deg]", "pitch", "yaw", ""},
              "lllrrrrrrl");
  for (const PlacedFrame& frame : c.frames) {
    std::vector<std::string> cells = {frame.name, frame.key.empty() ? "-" : frame.key, "the " + frame.in};
    for (const double p : frame.X.translation()) cells.push_back(fixed(1e3 * p));
    for (const double angle : rpy_of(frame.X.linear())) cells.push_back(fixed(angle * 180 / std::numbers::pi));
    cells.push_back(remark_of(c, frame));
    table.row(cells);
  }
  return "Estimated position and orientation of frames\n" + table.text() + "\n";
}

nlohmann::ordered_json frames_json(const Calibration& c) {
  auto list = nlohmann::ordered_json::array();
  for (const PlacedFrame& frame : c.frames) {
    const Eigen::Vector3d p = frame.X.translation(), rpy = rpy_of(frame.X.linear());
    const Eigen::Quaterniond q = quaternion_of(frame.X);
    list.push_back({{"name", frame.name},
                    {"key", frame.key.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(frame.key)},
                    {"in", frame.in},
                    {"position", {p.x(), p.y(), p.z()}},
                    {"rpy", {rpy.x(), rpy.y(), rpy.z()}},
                    {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}});
  }
  return list;
}

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
