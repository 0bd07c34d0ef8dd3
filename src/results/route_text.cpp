#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "nearest.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/results/route.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/table.hpp"
#include "posewright/version.hpp"
#include "sight_json.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

Json expected_or_null(const std::optional<ExpectedError>& e) { return e ? expected_error_json(*e) : Json(nullptr); }

Json motion_json(const RouteMotion& motion) {
  return {{"from", motion.from},
          {"to", motion.to},
          {"points", motion.points},
          {"seconds", motion.seconds},
          {"found_by", motion.found_by},
          {"change_seconds", motion.change_seconds},
          {"nearest", nearest_json(motion.nearest)}};
}

Json stop_json(const PlannedPose& pose) {
  Json values = Json::array();
  for (const NamedValue& v : pose.configuration) values.push_back(v.value);
  Json json = {{"id", pose.id}, {"configuration", values}};
  write_choices(json, pose.choices);
  if (!pose.actuators.empty()) json["actuators"] = actuators_json(pose);
  if (pose.tool_pose) json["tool_pose"] = tool_pose_json(*pose.tool_pose);
  if (pose.nearest) json["nearest"] = nearest_json(pose.nearest);
  if (!pose.sights.empty()) {
    json["targets"] = Json::array();
    for (const TargetSight& sight : pose.sights) json["targets"].push_back(sight_json(sight));
  }
  return json;
}

const RouteMotion* motion_to(const Route& route, int id) {
  for (const RouteMotion& motion : route.motions)
    if (motion.to == id) return &motion;
  return nullptr;
}

/// "joint_a2 rising, temperature 20"
std::string conditions_text(const PoseChoices& choices) {
  std::string text;
  for (const auto& [name, label] : choices)
    if (choice_key(name) == nullptr)
      text += (text.empty() ? "" : ", ") +
              (is_approach(name) ? name.substr(0, name.size() - approach_suffix.size()) : name) + " " + label;
  return text;
}

std::string steps_table(const Route& route) {
  std::vector<std::string> header = {"", "pose"};
  for (auto key = choice_keys.rbegin(); key != choice_keys.rend(); ++key) header.emplace_back(key->shown);
  header.insert(header.end(), {"motion", "via", "found by", "elapsed", "targets seen"});
  const bool conditions = !route.poses.empty() && !conditions_text(route.poses.front().choices).empty();
  if (conditions) header.emplace_back("conditions");
  Table table(std::move(header), "rr" + std::string(choice_keys.size(), 'l') + "rrlrrl");
  double elapsed = 0;
  for (std::size_t k = 0; k < route.poses.size(); ++k) {
    const PlannedPose& pose = route.poses[k];
    // A closed tour comes back to its first pose at the end only.
    const RouteMotion* motion = k == 0 && !route.from_home ? nullptr : motion_to(route, pose.id);
    if (motion != nullptr) elapsed += motion->seconds + motion->change_seconds;
    const auto seen =
        std::count_if(pose.sights.begin(), pose.sights.end(), [](const TargetSight& s) { return s.hidden_by.empty(); });
    std::vector<std::string> row = {std::to_string(k + 1), std::to_string(pose.id)};
    for (auto key = choice_keys.rbegin(); key != choice_keys.rend(); ++key)
      row.push_back(label_of(pose.choices, key->name));
    row.insert(
        row.end(),
        {motion == nullptr ? "" : seconds_text(motion->seconds),
         motion == nullptr || motion->points.size() < 3 ? "" : std::to_string(motion->points.size() - 2),
         motion == nullptr ? "" : motion->found_by, seconds_text(elapsed),
         pose.sights.empty() || !pose.sights.front().judged ? "" : fmt::format("{} of {}", seen, pose.sights.size())});
    if (conditions) row.push_back(conditions_text(pose.choices));
    table.row(std::move(row));
    elapsed += route.settle + (route.reading.empty() ? 0.0 : route.reading[k]);
  }
  return table.text();
}

std::string between_stops(const RouteMotion& motion) {
  const auto stop = [](int id) { return id == 0 ? std::string("home") : "pose " + std::to_string(id); };
  return fmt::format("between {} and {}", stop(motion.from), stop(motion.to));
}

std::string references_text(const Route& route) {
  std::string text;
  for (const ReferenceCheck& check : route.references) {
    text += fmt::format("Reference targets at pose {}:", check.pose);
    for (const TargetSight& s : check.sights)
      text += fmt::format("{} {}{}", &s == &check.sights.front() ? "" : ",", s.target,
                          s.hidden_by.empty() ? "" : " (" + s.hidden_by + ")");
    text += "\n";
  }
  return text;
}

}  // namespace

double Route::travel_seconds() const {
  double sum = 0;
  for (const RouteMotion& motion : motions) sum += motion.seconds;
  return sum;
}

double Route::change_seconds() const {
  double sum = 0;
  for (const RouteMotion& motion : motions) sum += motion.change_seconds;
  return sum;
}

double Route::reading_seconds() const { return std::accumulate(reading.begin(), reading.end(), 0.0); }

std::string route_json(const Route& route, const std::vector<WrittenWith>& files) {
  Json json = {{"schema", "posewright/route/1"},
               {"version", version},
               {"seed", route.seed},
               {"plan", route.plan_file},
               {"problem", problem_json(route.problem)},
               {"problem_changed", route.problem_changed},
               {"interrupted", route.interrupted},
               {"closed", route.closed},
               {"from_home", route.from_home},
               {"names", route.names},
               {"units", route.units},
               {"home", route.home}};
  if (!files.empty()) json["files"] = files_json(files);
  json["order"] = Json::array();
  for (const PlannedPose& pose : route.poses) json["order"].push_back(pose.id);
  json["seconds"] = {{"travel", route.travel_seconds()},
                     {"changes", route.change_seconds()},
                     {"settle", route.settle_seconds()},
                     {"reading", route.reading_seconds()},
                     {"planned_order_at_least", route.planned_seconds},
                     {"optimal", route.optimal}};
  json["poses"] = Json::array();
  for (const PlannedPose& pose : route.poses) json["poses"].push_back(stop_json(pose));
  json["motions"] = Json::array();
  for (const RouteMotion& motion : route.motions) json["motions"].push_back(motion_json(motion));
  json["references"] = Json::array();
  for (const ReferenceCheck& check : route.references) {
    Json sights = Json::array();
    for (const TargetSight& s : check.sights) sights.push_back(sight_json(s));
    json["references"].push_back({{"after_pose", check.pose}, {"targets", sights}});
  }
  json["unreachable"] = Json::array();
  for (const SkippedPose& skipped : route.unreachable)
    json["unreachable"].push_back({{"pose", skipped.pose}, {"reason", skipped.reason}});
  json["replaced"] = Json::array();
  for (const SkippedPose& lost : route.replaced)
    json["replaced"].push_back({{"pose", lost.pose}, {"reason", lost.reason}, {"by", lost.by}});
  json["worth"] = nullptr;
  if (const auto& worth = route.worth)
    json["worth"] = {{"efficiency", worth->efficiency},
                     {"expected_error_planned", expected_or_null(worth->planned)},
                     {"expected_error", expected_or_null(worth->left)}};
  return json_text(json);
}

std::string route_loss(const Route& route) {
  const std::size_t lost = route.unreachable.size(), replaced = route.replaced.size(), all = lost + route.poses.size();
  if (lost + replaced == 0) return {};
  std::string text;
  if (replaced > 0) text = fmt::format("{} of {} poses {} replaced", replaced, all, replaced == 1 ? "is" : "are");
  if (lost > 0)
    text += fmt::format("{}{} of {} poses {} left out", replaced > 0 ? ", " : "", lost, all, lost == 1 ? "is" : "are");
  if (!route.worth) return text + ": those left do not identify all parameters";
  text += fmt::format(": {:.1f} % of the plan's information is left", 100 * route.worth->efficiency);
  if (route.worth->planned && route.worth->left)
    text += fmt::format(", predicted position error {} in place of {}", error_text(*route.worth->left),
                        shown_value(route.worth->planned->usual().error, "m"));
  return text;
}

std::string route_summary(const Route& route) {
  std::string text = route_loss(route);
  if (!text.empty()) text += ".\n";
  if (route.problem_changed) text += "The problem file has changed since the plan was made.\n";
  const double total = route.travel_seconds() + route.change_seconds();
  text += fmt::format("{} in {} of motion", counted(long(route.poses.size()), "pose"),
                      seconds_text(route.travel_seconds()));
  if (route.change_seconds() > 0) text += fmt::format(" and {} of changes", seconds_text(route.change_seconds()));
  if (route.settle > 0) text += fmt::format(", {} at rest", seconds_text(route.settle_seconds()));
  if (route.reading_seconds() > 0) text += fmt::format(", {} of readings", seconds_text(route.reading_seconds()));
  text += route.from_home ? ", from home" : "";
  text += route.closed ? ", and back to the start.\n" : ".\n";
  if (const double still = route.settle_seconds() + route.reading_seconds(); still > 0)
    text += fmt::format("The whole job takes {}{}.\n", seconds_text(total + still),
                        route.reading_seconds() > 0 ? "" : ", readings not counted (motion: reading)");
  text += fmt::format("At the {:g} % of exported programs about {} of motion (export --speed).\n", usual_percent,
                      seconds_text(100 / usual_percent * route.travel_seconds()));
  if (route.planned_seconds > 0) {
    // A lower bound: where the ways around obstacles are longer than that, nothing is known to be saved.
    const double saved = 100 * (1 - total / route.planned_seconds);
    text += fmt::format("The plan's own order takes {} or more{}{}.\n", seconds_text(route.planned_seconds),
                        saved >= 0.5 ? fmt::format(": {:.0f} % saved", saved) : "",
                        route.optimal ? "; no order of such motions is shorter" : "");
  }
  if (route.interrupted) text += "The search was ended early; this is the shortest order by then.\n";
  text += "\n" + steps_table(route) + nearest_text(route.motions, between_stops) + references_text(route);
  for (const SkippedPose& skipped : route.unreachable)
    text += fmt::format("Pose {} is left out: {}.\n", skipped.pose, skipped.reason);
  for (const SkippedPose& lost : route.replaced)
    text += fmt::format("Pose {} is replaced by pose {}: {}.\n", lost.pose, lost.by, lost.reason);
  return text + fmt::format("Computed in {:.1f} s\n", route.computing_seconds);
}

std::string route_csv(const Route& route) {
  Plan plan;
  plan.poses = route.poses;
  return poses_csv(plan);
}

}  // namespace posewright
