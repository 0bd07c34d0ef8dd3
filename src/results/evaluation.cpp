#include "posewright/results/evaluation.hpp"

#include <fmt/format.h>

#include <cmath>

#include "posewright/criterion/registry.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

/// Criteria that are variances in m² are shown as what people know, their root in mm.
std::string shown_score(const CriterionScore& score, bool at_test_poses) {
  const CriterionEntry* entry = find_criterion(score.name);
  if (at_test_poses && entry != nullptr && entry->accuracy) return shown_value(std::sqrt(-score.value), "m");
  return fmt::format("{:.6g}", score.value);
}

std::string scores_text(const PoseListEvaluation& e) {
  Table table({"criterion", "value", "of the best of these candidates"});
  for (const CriterionScore& score : e.scores)
    table.row({score.name, shown_score(score, e.plan.rho0.has_value()),
               score.efficiency ? "at least " + percent(*score.efficiency) : "no bound"});
  return table.text();
}

std::string poses_text(const Plan& plan) {
  Table table({"pose", "share of the information", "left without it"}, "r");
  for (const PlannedPose& pose : plan.poses)
    table.row({std::to_string(pose.id) + (pose.measured ? " (measured)" : ""), percent(pose.contribution),
               pose.measured      ? ""
               : pose.without > 0 ? percent(pose.without)
                                  : "not identifiable"});
  return table.text();
}

std::string accuracy_of(const ListChange& change) {
  return change.rho0 ? ", predicted error " + shown_value(*change.rho0, "m") : "";
}

std::string drop_text(const ListChange& change) {
  std::string ids;
  for (const int id : change.poses) ids += (ids.empty() ? "" : ", ") + std::to_string(id);
  return fmt::format("Drop first: {} ({} remains{}).\n", ids, percent(change.efficiency), accuracy_of(change));
}

std::string add_text(const ListChange& change) {
  std::string text =
      fmt::format("Add: {} {} {} of the list{}.\n", counted(long(change.added.size()), "pose"),
                  change.added.size() == 1 ? "gives" : "give", percent(change.efficiency), accuracy_of(change));
  if (change.added.empty()) return text;
  std::vector<std::string> header{"pose"};
  for (const NamedValue& v : change.added.front().configuration) header.push_back(v.name);
  Table table(header, "r");
  for (const PlannedPose& pose : change.added) {
    std::vector<std::string> cells{std::to_string(pose.id)};
    for (const NamedValue& v : pose.configuration) cells.push_back(shown_value(v.value, v.unit));
    table.row(cells);
  }
  return text + table.text();
}

Json change_json(const ListChange& change) {
  Json json = {{"efficiency", change.efficiency}, {"log_det", change.log_det}, {"rho0", value_or_null(change.rho0)}};
  if (!change.poses.empty()) json["poses"] = change.poses;
  if (change.added.empty()) return json;
  json["poses"] = Json::array();
  for (const PlannedPose& pose : change.added) {
    Json names = Json::array(), values = Json::array();
    for (const NamedValue& v : pose.configuration) {
      names.push_back(v.name);
      values.push_back(v.value);
    }
    json["poses"].push_back({{"id", pose.id}, {"names", names}, {"configuration", values}});
    write_choices(json["poses"].back(), pose.choices);
  }
  return json;
}

}  // namespace

std::string evaluation_text(const PoseListEvaluation& e) {
  std::string text = plan_summary(e.plan) + "\n" + scores_text(e) + "\n" + poses_text(e.plan);
  if (e.drop) text += "\n" + drop_text(*e.drop);
  if (e.add) text += "\n" + add_text(*e.add);
  return text;
}

Json evaluation_json(const PoseListEvaluation& e) {
  Json json = parse_ordered_json(plan_json(e.plan));
  json["schema"] = "posewright/evaluation/1";
  json["scores"] = list_json(e.scores, [](const CriterionScore& score) {
    return Json{{"criterion", score.name}, {"value", score.value}, {"efficiency", value_or_null(score.efficiency)}};
  });
  json["drop"] = e.drop ? change_json(*e.drop) : Json(nullptr);
  json["add"] = e.add ? change_json(*e.add) : Json(nullptr);
  return json;
}

}  // namespace posewright
