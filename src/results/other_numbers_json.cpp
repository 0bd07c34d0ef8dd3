#include "posewright/results/other_numbers_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/sha256.hpp"
#include "sight_json.hpp"

namespace posewright {
namespace {

// Keys of a pose that follow from where it is, or that only name it.
constexpr std::array<std::string_view, 9> derived_keys = {
    "id", "candidate", "listed", "actuators", "tool_pose", "targets", "nearest", "contribution", "efficiency_without"};

// plan writes five; as many as a page has room for.
constexpr std::size_t most_points = 100;

bool is_derived(std::string_view key) {
  return std::find(derived_keys.begin(), derived_keys.end(), key) != derived_keys.end();
}

/// SHA-256 of what the points depend on: problem, variant, criterion, and the poses in any order.
template <class Json>
std::string identity_of(const Json& plan) {
  std::vector<std::string> poses;
  for (const auto& pose : plan.at("poses")) {
    nlohmann::json own = nlohmann::json::object();  // sorted by key
    for (const auto& [key, value] : pose.items())
      if (!is_derived(key)) own[key] = nlohmann::json(value);
    poses.push_back(json_text(own, JsonLayout::one_line));
  }
  std::sort(poses.begin(), poses.end());
  nlohmann::json all = {{"poses", poses}};
  nlohmann::json problem = nlohmann::json(plan.at("problem"));
  problem.erase("file");  // wherever it lies
  if (problem.contains("parameters")) problem["parameters"].erase("file");
  all["problem"] = problem;
  if (plan.contains("variant")) all["variant"] = nlohmann::json(plan.at("variant"));
  for (const char* key : {"name", "scaling", "prior"}) all[key] = nlohmann::json(plan.at("criterion").at(key));
  all["reserve"] = plan.at("criterion").value("reserve", false);
  // What report takes over from the plan for a search of its own.
  if (const auto& certificate = plan.at("certificate").at("candidates"); certificate.is_object())
    all["repeats"] = nlohmann::json(certificate.at("repeats"));
  if (const auto test = plan.find("discrimination"); test != plan.end() && test->is_object())
    all["truth"] = nlohmann::json(test->at("truth"));
  if (plan.contains("variants"))
    for (const auto& variant : plan.at("variants")) all["variants"].push_back(nlohmann::json(variant.at("name")));
  return sha256_hex(json_text(all, JsonLayout::one_line));
}

/// Throws InputError about a value of the key.
[[noreturn]] void refuse(const std::string& file, const std::string& what, const std::string& allowed) {
  throw InputError({file, 0}, "other_numbers: " + what, allowed + "; without the key, report computes it again");
}

/// None for null, where that may be.
std::optional<double> number_of(const nlohmann::json& point, const char* key, const std::string& name, bool may_lack,
                                const std::string& file) {
  const auto found = point.find(key);
  if (may_lack && found != point.end() && found->is_null()) return std::nullopt;
  if (found == point.end() || !found->is_number() || !std::isfinite(found->get<double>()))
    refuse(file, fmt::format("{} has no {}", name, key), may_lack ? "a number or null" : "a number");
  return found->get<double>();
}

CurvePoint point_of(const nlohmann::json& point, std::size_t i, const std::string& file) {
  const std::string name = fmt::format("points[{}]", i);
  if (!point.is_object() || !point.contains("poses") || !point["poses"].is_number_unsigned() ||
      point["poses"].get<std::uint64_t>() < 1 || point["poses"].get<std::uint64_t>() > 1'000'000)
    refuse(file, name + " has no number of poses", "`poses` is an integer from 1 on");
  CurvePoint read{point["poses"].get<int>(), *number_of(point, "log_det", name, false, file),
                  number_of(point, "rho0", name, true, file),
                  number_of(point, "largest_sigma_ratio", name, true, file)};
  if (read.rho0.value_or(0) < 0 || read.worst_sigma.value_or(0) < 0)
    refuse(file, name + " has a negative error", "rho0 and largest_sigma_ratio from 0 on");
  return read;
}

}  // namespace

nlohmann::ordered_json other_numbers_json(const nlohmann::ordered_json& plan, const std::vector<CurvePoint>& points) {
  nlohmann::ordered_json json = {{"of", identity_of(plan)}, {"points", nlohmann::ordered_json::array()}};
  for (const CurvePoint& point : points) json["points"].push_back(curve_point_json(point));
  return json;
}

std::optional<std::vector<CurvePoint>> read_other_numbers(const nlohmann::json& plan, const std::string& file) {
  const auto found = plan.find("other_numbers");
  if (found == plan.end()) return std::nullopt;
  if (!found->is_object() || !found->contains("of") || !(*found)["of"].is_string())
    refuse(file, "has no `of`", "SHA-256 of problem, criterion and poses, as plan writes it");
  if (!found->contains("points") || !(*found)["points"].is_array())
    refuse(file, "has no `points`", "a list of numbers of poses and what they reach");
  if ((*found)["points"].size() > most_points)
    refuse(file, fmt::format("has {} points", (*found)["points"].size()), fmt::format("at most {}", most_points));
  std::vector<CurvePoint> points;
  for (const nlohmann::json& point : (*found)["points"]) points.push_back(point_of(point, points.size(), file));
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].poses <= points[i - 1].poses)
      refuse(file, fmt::format("points[{}] has no more poses than the one before", i), "ascending numbers of poses");
  if ((*found)["of"].get<std::string>() != identity_of(plan)) return std::nullopt;
  const auto own = std::count_if(plan.at("poses").begin(), plan.at("poses").end(),
                                 [](const nlohmann::json& pose) { return !pose.value("measured", false); });
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].poses == own) refuse(file, fmt::format("points[{}] has the plan's own number", i), "other numbers");
  return points;
}

}  // namespace posewright
