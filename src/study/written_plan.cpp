#include "posewright/study/written_plan.hpp"

#include <algorithm>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/model/elastic_chain.hpp"
#include "posewright/problem/design_keys.hpp"
#include "posewright/results/other_numbers_json.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

using Json = nlohmann::json;

[[noreturn]] void throw_no_plan(const std::filesystem::path& file) {
  throw InputError({file.string(), 0}, "is not a plan of a robot", "plan.json as posewright plan writes it");
}

void fill_design(WrittenPlan& plan, const Json& json) {
  const auto say = [&](const char* key, const std::string& value) { plan.design.emplace_back(key, value); };
  const Json& poses = json.at("poses");
  plan.poses =
      int(std::count_if(poses.begin(), poses.end(), [](const Json& p) { return !p.value("measured", false); }));
  say("design.poses", std::to_string(plan.poses));
  const Json& criterion = json.at("criterion");
  say("design.criterion", criterion.at("name").get<std::string>());
  if (json.value("variants", Json::array()).empty()) say("design.variant", json.at("variant").get<std::string>());
  if (const auto test = json.find("discrimination"); test != json.end() && test->is_object())
    say("design.truth", test->at("truth").get<std::string>());
  if (criterion.value("reserve", false)) say("design.reserve", "yes");
  say("design.prior", criterion.at("prior").get<std::string>());
  say("design.scaling", criterion.at("scaling").get<std::string>());
  say("design.candidates", std::to_string(json.at("statistics").at("candidates_feasible").get<long>()));
  plan.seed = json.at("seed").get<std::uint64_t>();
  if (const Json& certificate = json.at("certificate").at("candidates"); certificate.is_object())
    say("design.repeats", certificate.at("repeats").get<std::string>());
}

void fill_parameters(WrittenPlan& plan, const Json& json) {
  const auto variant = json.at("variant").get<std::string>();
  for (const Json& parameter : json.at("parameters")) {
    const auto name = parameter.at("name").get<std::string>();
    if (is_numbered_place(name))
      throw InputError({plan.file.string(), 0},
                       "was made when compliances at listed positions were numbered: '" + name + "'",
                       "plan again; the numbers followed the sorted positions, so they cannot be taken over");
    if (parameter.at("identifiable").get<bool>()) plan.parameters[parameter.value("variant", variant)].push_back(name);
  }
}

}  // namespace

WrittenPlan read_written_plan(const std::filesystem::path& file) {
  WrittenPlan plan;
  plan.file = file;
  plan.text = read_text(file, plan_size_limit);
  try {
    const Json json = parse_json(plan.text);
    if (json.value("schema", "") != "posewright/plan/1" || json.at("variant").get<std::string>().empty())
      throw_no_plan(file);
    fill_design(plan, json);
    fill_parameters(plan, json);
    plan.other_numbers = read_other_numbers(json, file.string());
    plan.log_det = json.at("criterion").at("log_det").get<double>();
    if (const Json rho0 = json.value("/accuracy/rho0"_json_pointer, Json()); rho0.is_number())
      plan.rho0 = rho0.get<double>();
    plan.problem_sha256 = json.at("problem").value("sha256", "");
    if (json["problem"].contains("parameters")) {
      const Json& parameters = json["problem"]["parameters"];
      plan.parameters_file = {parameters.at("file").get<std::string>(), parameters.at("sha256").get<std::string>(),
                              parameters.at("variant").get<std::string>()};
    }
  } catch (const Json::exception&) {
    throw_no_plan(file);
  }
  if (plan.poses == 0) throw_no_plan(file);
  return plan;
}

Problem as_written(Problem problem, const WrittenPlan& plan) {
  for (const auto& [key, value] : plan.design)
    set(problem, key, value, plan.file.string() + ": " + design_key(key).name());
  return problem;
}

PoseList poses_of(const Plan& plan, const std::vector<Coordinate>& coordinates) {
  return read_poses_text(plan_json(plan), "plan", coordinates);
}

}  // namespace posewright
