#include "posewright/results/stations.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <variant>

#include "document.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/table.hpp"

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

/// Nominal position of the robot's base in the measurement frame, x, y, z in m; null for a robot without one.
Json base_json(const Problem& problem) {
  const std::optional<Placement> base = base_of(problem.robot);
  return base ? point_json(base->position) : Json(nullptr);
}

/// Obstacles as a map needs them: name and the points whose convex hull the body is, m, measurement frame; no points
/// for planes and meshes. Bodies of the instruments themselves are left out: they stand where the map is asked for.
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

using Json = nlohmann::ordered_json;

std::string names_of(const StationRank& rank) {
  std::string names;
  for (const StationSpec& station : rank.stations) names += (names.empty() ? "" : ", ") + station.name;
  return names;
}

std::string places_of(const StationRank& rank) {
  std::string places;
  for (const StationSpec& station : rank.stations) {
    const Eigen::Vector3d& p = station.placement.position;
    places += fmt::format("{}({:.3f}, {:.3f}, {:.3f})", places.empty() ? "" : "; ", p.x(), p.y(), p.z());
  }
  return places;
}

/// A full plan that was cut short leaves the quick one.
bool looked_at(const StationRank& rank) { return !rank.stopped || rank.why_not.empty(); }

/// Note on an early end; empty: complete.
std::string ended_early(const std::vector<StationRank>& ranks) {
  const auto count = [&](auto&& which) { return std::count_if(ranks.begin(), ranks.end(), which); };
  if (count([](const StationRank& r) { return r.stopped; }) == 0) return {};
  return fmt::format("Ended early: {} of {} scored, {} planned in full.\n", count(looked_at), ranks.size(),
                     count([](const StationRank& r) { return r.in_full; }));
}

}  // namespace

std::string stations_text(const std::vector<StationRank>& ranks) {
  Table table({"", "station", "place [m]", "planned", "parameters", "criterion", "σ", "feasible", "predicted error",
               "from noise alone", "most rejected by"},
              "rrlllrrrrrl");
  int place = 0;
  for (const StationRank& rank : ranks) {
    if (!rank.why_not.empty()) continue;
    table.row({std::to_string(++place), names_of(rank), places_of(rank), rank.in_full ? "in full" : "quickly",
               std::to_string(rank.parameters), fmt::format("{:.4f}", rank.phi),
               rank.sigma_ratio ? fmt::format("{:.2f} ×", *rank.sigma_ratio) : "",
               fmt::format("{:.1f} %", 100 * rank.feasible_share),
               rank.expected ? with_effect_text(*rank.expected) : "",
               rank.expected ? shown_value(rank.expected->by_noise, "m") : "", rank.main_rejection});
  }
  std::string text = table.text();
  text +=
      "feasible: share of the configurations drawn; where the instrument sees its targets from few of them, views of "
      "the "
      "targets are drawn instead.\n";
  if (const auto& expected = ranks.front().expected)
    text +=
        fmt::format("predicted error: {}, root mean square at {}.\n", origin_text(*expected), places_text(*expected));
  text += ended_early(ranks);
  for (const StationRank& rank : ranks)
    if (!rank.why_not.empty() && !rank.stopped) text += fmt::format("{}: no plan: {}\n", names_of(rank), rank.why_not);
  text += "\nFor measurement: device:\n  stations:\n";
  for (const StationSpec& station : ranks.front().stations) {
    const Eigen::Vector3d &p = station.placement.position, &r = station.placement.rpy;
    text += fmt::format("    {}: {{position: [{}, {}, {}], rpy: [{}, {}, {}]}}\n", station.name, p.x(), p.y(), p.z(),
                        r.x(), r.y(), r.z());
  }
  return text;
}

Json stations_json(const Problem& problem, std::uint64_t seed, const std::string& criterion,
                   const std::vector<StationRank>& ranks) {
  Json list = Json::array();
  for (const StationRank& rank : ranks) {
    Json stations = Json::object();
    for (const StationSpec& s : rank.stations)
      stations[s.name] = {{"position", {s.placement.position.x(), s.placement.position.y(), s.placement.position.z()}},
                          {"rpy", {s.placement.rpy.x(), s.placement.rpy.y(), s.placement.rpy.z()}}};
    Json json = {{"stations", stations}, {"looked_at", looked_at(rank)}};
    if (!rank.why_not.empty()) {
      json["why_not"] = rank.why_not;
    } else {
      json["in_full"] = rank.in_full;
      json["parameters"] = rank.parameters;
      json["phi"] = rank.phi;
      json["criterion_value"] = rank.criterion_value;
      json["sigma_ratio"] = rank.sigma_ratio ? Json(*rank.sigma_ratio) : Json(nullptr);
      json["feasible_share"] = rank.feasible_share;
      json["main_rejection"] = rank.main_rejection;
      json["expected_error"] = rank.expected ? expected_error_json(*rank.expected) : Json(nullptr);
    }
    list.push_back(json);
  }
  Json json = begin_document("posewright/stations/1", problem, seed);
  json["variant"] = find_variant(problem, "").name;
  json["criterion"] = criterion;
  json["base"] = base_json(problem);
  json["obstacles"] = obstacles_json(problem);
  json["interrupted"] = !ended_early(ranks).empty();
  json["ranking"] = list;
  return json;
}

}  // namespace posewright
