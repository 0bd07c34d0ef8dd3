#include <nlohmann/json.hpp>

#include "posewright/outputs/write_plan.hpp"
#include "posewright/version.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

Json criterion_json(const Plan& plan) {
  const ObservabilityIndices& o = plan.indices;
  return {{"name", plan.criterion},
          {"value", plan.criterion_value},
          {"log_det", plan.log_det},
          {"log_det_full", plan.log_det_full},
          {"indices", {{"o1", o.o1}, {"o2", o.o2}, {"o3", o.o3}, {"o4", o.o4}, {"o5", o.o5}}},
          {"scaling", "tolerance"},
          {"prior", plan.prior ? "tolerance" : "none"}};
}

Json certificate_json(const Certificate& c) {
  if (!c.proved) return {{"candidates", nullptr}, {"workspace", nullptr}};
  return {{"candidates",
           {{"efficiency", c.efficiency},
            {"log_det_bound", c.log_det_bound},
            {"max_sensitivity_ratio", c.max_sensitivity_ratio},
            {"count", c.count},
            {"repeats", c.repeats ? "allow" : "forbid"}}},
          // A bound over the continuous workspace has not been computed: no number is better than a made-up one.
          {"workspace", nullptr}};
}

Json parameter_json(const PlannedParameter& p) {
  Json json = {{"name", p.label.name},
               {"unit", p.label.unit},
               {"role", p.label.role == Role::interest ? "interest" : "nuisance"},
               {"nominal", p.label.nominal},
               {"tolerance", p.label.tolerance},
               {"sigma", p.sigma ? Json(*p.sigma) : Json(nullptr)},
               {"identifiable", p.sigma.has_value()}};
  if (p.sigma) json["worth_identifying"] = *p.sigma < p.label.tolerance;
  if (!p.dropped_because.empty()) json["dropped_because"] = p.dropped_because;
  return json;
}

Json tool_pose_json(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  const Eigen::Vector3d p = X.translation();
  return {{"position", {p.x(), p.y(), p.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

Json pose_json(const PlannedPose& pose) {
  Json json = {{"id", pose.id}, {"candidate", pose.candidate}};
  if (!pose.configuration.empty()) {
    Json values = Json::array(), names = Json::array(), units = Json::array();
    for (const NamedValue& v : pose.configuration) {
      values.push_back(v.value);
      names.push_back(v.name);
      units.push_back(v.unit);
    }
    json["configuration"] = values;
    json["names"] = names;
    json["units"] = units;
    json["load_case"] = pose.load_case.empty() ? Json(nullptr) : Json(pose.load_case);
    json["station"] = pose.station.empty() ? Json(nullptr) : Json(pose.station);
  }
  if (!pose.actuators.empty()) {
    Json actuators = Json::object();
    for (const NamedValue& v : pose.actuators) actuators[v.name] = v.value;
    json["actuators"] = actuators;
  }
  if (pose.tool_pose) json["tool_pose"] = tool_pose_json(*pose.tool_pose);
  json["contribution"] = pose.contribution;
  return json;
}

Json statistics_json(const PlanStatistics& s) {
  Json rejected = Json::object();
  for (const auto& [reason, count] : s.rejected) rejected[reason] = count;
  Json json = {{"candidates_drawn", s.drawn}, {"candidates_feasible", s.feasible},
               {"rejected", rejected},        {"exchanges", s.exchanges},
               {"restarts", s.restarts},      {"seconds", s.seconds}};
  if (s.poses_on_boundary) json["poses_on_boundary"] = *s.poses_on_boundary;
  if (s.coordinates_on_limits) json["coordinates_on_limits"] = *s.coordinates_on_limits;
  return json;
}

}  // namespace

std::string plan_json(const Plan& plan) {
  Json json = {{"schema", "posewright/plan/1"},
               {"version", version},
               {"seed", plan.seed},
               {"problem", {{"file", plan.problem_file}, {"sha256", plan.problem_sha256}}}};
  if (!plan.variant.empty()) json["variant"] = plan.variant;
  json["interrupted"] = plan.interrupted;
  json["criterion"] = criterion_json(plan);
  json["certificate"] = certificate_json(plan.certificate);
  json["parameters"] = Json::array();
  for (const PlannedParameter& p : plan.parameters) json["parameters"].push_back(parameter_json(p));
  json["accuracy"] = {{"rho0", plan.rho0 ? Json(*plan.rho0) : Json(nullptr)}, {"test_poses", plan.test_errors}};
  json["poses"] = Json::array();
  for (const PlannedPose& pose : plan.poses) json["poses"].push_back(pose_json(pose));
  json["statistics"] = statistics_json(plan.statistics);
  return json.dump(1) + "\n";
}

}  // namespace posewright
