#include "posewright/formats/json_values.hpp"
#include "posewright/results/discrimination.hpp"
#include "posewright/results/other_numbers_json.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/text.hpp"
#include "posewright/version.hpp"
#include "sight_json.hpp"

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
          {"scaling", plan.scaling},
          {"prior", plan.prior ? "tolerance" : "none"},
          {"reserve", plan.reserve}};
}

Json certificate_json(const Plan& plan) {
  const Certificate& c = plan.certificate;
  if (!c.proved) return {{"candidates", nullptr}, {"workspace", nullptr}};
  Json candidates = {{"efficiency", c.efficiency}, {"bound", c.bound}};
  if (plan.determinant) candidates["log_det_bound"] = c.bound;
  candidates["max_sensitivity_ratio"] = c.max_sensitivity_ratio;
  candidates["count"] = c.count;
  candidates["found"] = c.found;
  candidates["repeats"] = c.repeats;
  candidates["apart"] = c.apart;
  candidates["limited"] = c.limited;
  candidates["optimal"] = plan.proved_optimal;
  candidates["minimum_distance"] = plan.minimum_distance.empty() ? Json(nullptr) : Json(plan.minimum_distance);
  Json workspace = nullptr;
  if (c.workspace)
    workspace = {{"efficiency", c.workspace->efficiency},
                 {"bound", c.workspace->bound},
                 {"max_sensitivity_ratio", c.workspace->max_sensitivity_ratio},
                 {"method", c.workspace->method},
                 {"proved", c.workspace->proved},
                 {"settled", c.workspace->settled},
                 {"at_most", c.workspace->at_most},
                 {"within", c.workspace->within},
                 {"limits", c.workspace->limits},
                 {"why_not_proved", c.workspace->proved ? Json(nullptr) : Json(c.workspace->why_not)},
                 {"boxes", c.workspace->boxes},
                 {"loose_proof", c.workspace->loose_bound ? Json{{"efficiency", c.workspace->loose_efficiency},
                                                                 {"bound", *c.workspace->loose_bound}}
                                                          : Json(nullptr)}};
  return {{"candidates", candidates}, {"workspace", workspace}};
}

Json variants_json(const Plan& plan) {
  Json json = Json::array();
  for (const VariantResult& v : plan.variants)
    json.push_back({{"name", v.name},
                    {"weight", v.weight},
                    {"log_det", v.log_det},
                    {"log_det_bound", v.bound},
                    {"efficiency", v.efficiency}});
  return json;
}

Json instruments_json(const Plan& plan) {
  Json json = Json::array();
  for (const InstrumentWorth& worth : plan.instruments) {
    Json sigmas = nullptr;
    for (const auto& [name, sigma] : worth.sigma_without) sigmas[name] = sigma;
    json.push_back({{"name", worth.name},
                    {"poses", worth.poses},
                    {"setup_seconds", worth.setup},
                    {"reading_seconds", worth.reading},
                    {"share", worth.share},
                    {"efficiency_without", worth.without},
                    {"sigma_without", sigmas},
                    {"expected_error_without",
                     worth.expected_without ? expected_error_json(*worth.expected_without) : Json(nullptr)}});
  }
  return json;
}

Json curve_json(const Plan& plan) {
  Json json = Json::array();
  for (const CurvePoint& point : plan.curve) {
    json.push_back(curve_point_json(point));
    json.back()["enough"] = point.enough;
    json.back()["largest_axis_ratio"] = point.worst_axis ? Json(*point.worst_axis) : Json(nullptr);
  }
  return json;
}

Json parameter_json(const PlannedParameter& p) {
  Json json = Json::object();
  if (!p.variant.empty()) json["variant"] = p.variant;
  json.update({{"name", p.label.name},
               {"unit", p.label.unit},
               {"role", p.label.role == Role::interest ? "interest" : "nuisance"},
               {"nominal", p.label.nominal},
               {"tolerance", p.label.tolerance},
               {"sigma", p.sigma ? Json(*p.sigma) : Json(nullptr)},
               {"identifiable", p.sigma.has_value()}});
  if (p.sigma) json["worth_identifying"] = *p.sigma < p.label.tolerance;
  if (!p.dropped_because.empty()) json["dropped_because"] = p.dropped_because;
  return json;
}

}  // namespace

nlohmann::ordered_json sight_json(const TargetSight& sight) {
  return {{"target", sight.target},
          {"station", sight.station},
          {"position", {sight.position.x(), sight.position.y(), sight.position.z()}},
          {"distance", sight.distance},
          {"azimuth", sight.azimuth},
          {"elevation", sight.elevation},
          {"incidence", sight.incidence ? Json(*sight.incidence) : Json(nullptr)},
          {"visible", sight.judged ? Json(sight.hidden_by.empty()) : Json(nullptr)},
          {"hidden_by", sight.hidden_by.empty() ? Json(nullptr) : Json(sight.hidden_by)}};
}

nlohmann::ordered_json actuators_json(const PlannedPose& pose) {
  Json actuators = Json::object();
  for (const NamedValue& v : pose.actuators) actuators[v.name] = v.value;
  return actuators;
}

nlohmann::ordered_json nearest_json(const std::optional<BodyDistance>& nearest) {
  if (!nearest) return nullptr;
  Json json = {{"distance", nearest->distance}, {"between", {nearest->first, nearest->second}}};
  if (nearest->points)
    for (const Eigen::Vector3d& p : *nearest->points) json["points"].push_back({p.x(), p.y(), p.z()});
  return json;
}

nlohmann::ordered_json tool_pose_json(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  const Eigen::Vector3d p = X.translation();
  return {{"position", {p.x(), p.y(), p.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

nlohmann::ordered_json problem_json(const ProblemOrigin& problem) {
  const ParametersFile& parameters = problem.parameters;
  Json json = {{"file", problem.file}, {"sha256", problem.sha256}};
  for (const KeyEdit& edit : problem.changed) json["set"].push_back({{"key", edit.key}, {"value", edit.value}});
  if (!parameters.file.empty())
    json["parameters"] = {{"file", parameters.file}, {"sha256", parameters.sha256}, {"variant", parameters.variant}};
  return json;
}

nlohmann::ordered_json planned_pose_json(const PlannedPose& pose) {
  Json json = {{"id", pose.id}, {"candidate", pose.candidate ? Json(*pose.candidate) : Json(nullptr)}};
  if (pose.listed)
    json["listed"] = {{"id", pose.listed->id},
                      {"line", pose.listed->line > 0 ? Json(pose.listed->line) : Json(nullptr)}};
  if (pose.measured) json["measured"] = true;
  if (pose.fixed) json["fixed"] = true;
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
    write_choices(json, pose.choices);
  }
  if (!pose.actuators.empty()) json["actuators"] = actuators_json(pose);
  if (pose.tool_pose) json["tool_pose"] = tool_pose_json(*pose.tool_pose);
  if (!pose.sights.empty()) {
    json["targets"] = Json::array();
    for (const TargetSight& sight : pose.sights) json["targets"].push_back(sight_json(sight));
  }
  if (pose.nearest) json["nearest"] = nearest_json(pose.nearest);
  json["contribution"] = pose.contribution;
  if (!pose.measured) json["efficiency_without"] = pose.without;
  return json;
}

nlohmann::ordered_json curve_point_json(const CurvePoint& point) {
  return {{"poses", point.poses},
          {"log_det", point.log_det},
          {"rho0", point.rho0 ? Json(*point.rho0) : Json(nullptr)},
          {"largest_sigma_ratio", point.worst_sigma ? Json(*point.worst_sigma) : Json(nullptr)}};
}

namespace {

Json cell_json(const CellNotes& cell) {
  Json margins = Json::object();
  for (const NamedValue& v : cell.joint_margins) margins[v.name] = v.value;
  Json reduced = Json::array();
  for (const BodyDistance& pair : cell.reduced)
    reduced.push_back({{"between", {pair.first, pair.second}}, {"clearance", pair.distance}});
  return {{"always_touching", cell.always_touching},
          {"reduced_clearances", reduced},
          {"uncalibrated_margin", cell.margin},
          {"uncalibrated_joint_margins", margins}};
}

Json statistics_json(const PlanStatistics& s) {
  Json rejected = Json::object();
  for (const auto& [reason, count] : s.rejected) rejected[reason] = count;
  Json json = {{"candidates_drawn", s.drawn}, {"candidates_feasible", s.feasible},
               {"rejected", rejected},        {"exchanges", s.exchanges},
               {"restarts", s.restarts},      {"seconds", s.seconds}};
  if (!s.list.empty()) json["candidates_from"] = s.list;
  if (!s.notes.empty()) json["notes"] = s.notes;
  if (!s.stages.empty()) {
    json["stages"] = Json::array();
    for (const PlanStage& stage : s.stages)
      json["stages"].push_back({{"name", stage.name},
                                {"value", stage.value},
                                {"efficiency", stage.efficiency ? Json(*stage.efficiency) : Json(nullptr)},
                                {"seconds", stage.seconds}});
  }
  if (!s.cell.always_touching.empty() || !s.cell.reduced.empty() || s.cell.margin > 0 || !s.cell.joint_margins.empty())
    json["cell"] = cell_json(s.cell);
  for (const LimitMargin& m : s.limit_margins) json["limit_margins"][m.name] = m.margin;
  if (s.poses_on_boundary) json["poses_on_boundary"] = *s.poses_on_boundary;
  if (s.coordinates_on_limits) json["coordinates_on_limits"] = *s.coordinates_on_limits;
  return json;
}

Json robust_json(const RobustPlan& robust) {
  Json json = {{"draws", robust.draws},           {"measure", robust_aim_text(robust.aim)},
               {"value", robust.value},           {"bound", robust.bound},
               {"unreached", robust.unreached},   {"interrupted", robust.stopped},
               {"efficiency", robust.efficiency}, {"log_det_bound", robust.references}};
  if (robust.searched) json["nominal_plan"] = {{"value", robust.nominal_value}, {"efficiency", robust.nominal}};
  return json;
}

Json unmodelled_json(const PlannedEffect& effect) {
  const auto value = [](const std::optional<double>& v) { return v ? Json(*v) : Json(nullptr); };
  return {{"size", effect.size},
          {"size_assumed", effect.size_assumed},
          {"rotation", effect.rotation},
          {"length", effect.length},
          {"features", effect.features},
          {"feature_error", effect.feature_error},
          {"by_noise", value(effect.by_noise)},
          {"by_repeatability", value(effect.by_repeatability)},
          {"by_effect", value(effect.by_effect)},
          {"interpolated", value(effect.interpolated)}};
}

}  // namespace

nlohmann::ordered_json files_json(const std::vector<WrittenWith>& files) {
  Json json = Json::array();
  for (const WrittenWith& file : files) json.push_back({{"path", file.path}, {"sha256", file.sha256}});
  return json;
}

std::string plan_json(const Plan& plan, const std::vector<WrittenWith>& files) {
  Json json = {{"schema", "posewright/plan/1"},
               {"version", version},
               {"seed", plan.seed},
               {"problem", problem_json(plan.problem)}};
  if (!files.empty()) json["files"] = files_json(files);
  if (!plan.variant.empty()) json["variant"] = plan.variant;
  json["method"] = plan.method;
  json["interrupted"] = plan.interrupted;
  json["criterion"] = criterion_json(plan);
  json["certificate"] = certificate_json(plan);
  if (plan.discrimination) json["discrimination"] = discrimination_json(*plan.discrimination);
  if (plan.robust) json["robust"] = robust_json(*plan.robust);
  if (plan.unmodelled) json["unmodelled"] = unmodelled_json(*plan.unmodelled);
  if (plan.expected) json["expected_error"] = expected_error_json(*plan.expected);
  if (!plan.variants.empty()) json["variants"] = variants_json(plan);
  if (!plan.instruments.empty()) {
    json["instruments"] = instruments_json(plan);
    json["prior_share"] = plan.prior_share;
  }
  if (!plan.curve.empty()) json["curve"] = curve_json(plan);
  json["parameters"] = Json::array();
  for (const PlannedParameter& p : plan.parameters) json["parameters"].push_back(parameter_json(p));
  json["accuracy"] = {{"rho0", plan.rho0 ? Json(*plan.rho0) : Json(nullptr)},
                      {"test_poses", plan.test_errors},
                      {"rotation", plan.turn ? Json(*plan.turn) : Json(nullptr)},
                      {"test_pose_sigmas", plan.test_axes}};
  json["poses"] = Json::array();
  for (const PlannedPose& pose : plan.poses) json["poses"].push_back(planned_pose_json(pose));
  json["statistics"] = statistics_json(plan.statistics);
  if (plan.other_numbers) json["other_numbers"] = other_numbers_json(json, *plan.other_numbers);
  return json_text(json);
}

}  // namespace posewright
