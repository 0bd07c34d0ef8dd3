#include "posewright/study/written_plan.hpp"

#include <algorithm>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/model/elastic_chain.hpp"
#include "posewright/problem/design_words.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

using Json = nlohmann::json;

[[noreturn]] void throw_no_plan(const std::filesystem::path& file) {
  throw InputError({file.string(), 0}, "is not a plan of a robot", "plan.json as posewright plan writes it");
}

PlanOptions options_of(const Json& plan) {
  PlanOptions options;
  const Json& poses = plan.at("poses");
  options.poses =
      int(std::count_if(poses.begin(), poses.end(), [](const Json& p) { return !p.value("measured", false); }));
  const Json& criterion = plan.at("criterion");
  options.criterion = criterion.at("name").get<std::string>();
  if (plan.value("variants", Json::array()).empty()) options.variant = plan.at("variant").get<std::string>();
  if (const auto test = plan.find("discrimination"); test != plan.end() && test->is_object())
    options.truth = test->at("truth").get<std::string>();
  options.reserve = criterion.value("reserve", false);
  options.prior = criterion.at("prior").get<std::string>() == "tolerance";
  options.scaling = scaling_of(criterion.at("scaling").get<std::string>()).value();
  options.candidates = int(plan.at("statistics").at("candidates_feasible").get<long>());
  options.seed = plan.at("seed").get<std::uint64_t>();
  if (const Json& certificate = plan.at("certificate").at("candidates"); certificate.is_object())
    options.repeats = repeats_of(certificate.at("repeats").get<std::string>()).value();
  return options;
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
    plan.options = options_of(json);
    for (const Json& parameter : json.at("parameters"))
      if (const auto name = parameter.at("name").get<std::string>(); is_numbered_place(name))
        throw InputError({file.string(), 0},
                         "was made when compliances at listed positions were numbered: '" + name + "'",
                         "plan again; the numbers followed the sorted positions, so they cannot be taken over");
    plan.log_det = json.at("criterion").at("log_det").get<double>();
    plan.problem_sha256 = json.at("problem").value("sha256", "");
    if (json["problem"].contains("parameters")) {
      const Json& parameters = json["problem"]["parameters"];
      plan.parameters_file = {parameters.at("file").get<std::string>(), parameters.at("sha256").get<std::string>(),
                              parameters.at("variant").get<std::string>()};
    }
  } catch (const Json::exception&) {
    throw_no_plan(file);
  } catch (const std::bad_optional_access&) {  // a word that is none
    throw_no_plan(file);
  }
  if (*plan.options.poses == 0) throw_no_plan(file);
  return plan;
}

}  // namespace posewright
