#include <fmt/format.h>

#include "command.hpp"
#include "planners/registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/problem/design_words.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "problem_source.hpp"
#include "task_options.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description plan_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                               //
      ("poses", text("N|auto"), "number of poses; auto: the smallest that reaches design: require")   //
      ("variant", text("V"), "model variant (design: variant, else the first)")                       //
      ("truth", text("V"), "alternative model to test the fitted one against (design: truth)")        //
      ("criterion", text("NAME"), ("criterion to maximise: " + criterion_names() + " (o1)").c_str())  //
      ("method", text("NAME"), ("planner: " + planner_names() + " (auto)").c_str())                   //
      ("candidates", text("n"),
       help_with_default("feasible configurations to choose from", default_candidates).c_str())                       //
      ("candidates-from", text("FILE"), "choose among these configurations instead (CSV, plan.json, measured data)")  //
      ("validation", text("k"),
       "k additional poses for validation: plan-validation.json, poses-validation.csv")  //
      ("restarts", text("k"), "starts of the search (10)")                               //
      ("repeats", text("allow|forbid|k"), "how often a pose may be measured (forbid)")(
          "scaling", text("tolerance|norm|none"), "units of the columns for o2 to o5 and a (tolerance)")(
          "augment", text("POSES"), "already measured poses, CSV or plan.json; plans N additional ones")(
          "fixed", text("POSES"),
          "poses that must be in the plan, CSV or plan.json; with a column `fixed`, only rows marked yes")(
          "reserve", "optimise for the loss of the worst single pose")(
          "robust", text("K"), "plan for K robots drawn from the tolerances, not for the nominal one alone")(
          "robust-measure", text("M"),
          "summary of their efficiencies: mean, worst, or tail 0.1 for the worst tenth (mean)")(
          "prior", text("none|tolerance"), "use tolerances as prior knowledge (none)")(
          "gap", text("P"), "stop the workspace proof at this gap, in percent (0.1)")(
          "proof-time", text("S"),
          "time limit of the workspace proof in seconds; 0: no proof (an amount of work, some seconds)");
  options.add(output_options(true)).add(resume_option());
  options.add(problem_options());
  return options;
}

int run_plan(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const std::filesystem::path file = single(positional, "PROBLEM");
  PlanOptions plan_options;
  plan_options.variant = text_of(values, "variant");
  plan_options.truth = text_of(values, "truth");
  plan_options.criterion = text_of(values, "criterion");
  plan_options.method = text_of(values, "method");
  plan_options.smallest = text_of(values, "poses") == "auto";
  if (!plan_options.smallest) plan_options.poses = whole_number(values, "poses", 1, 1000000);
  plan_options.candidates = whole_number(values, "candidates", 1, 10000000);
  plan_options.restarts = whole_number(values, "restarts", 1, 1000000);
  plan_options.repeats = repeats_of(values);
  if (const auto gap = number_below(values, "gap", 100, "percent, above 0 and below 100, are allowed"))
    plan_options.proof.gap = *gap / 100;
  plan_options.proof.seconds =
      text_of(values, "proof-time") == "0"
          ? 0.0
          : number_below(values, "proof-time", 1e9, "a number of seconds is allowed; 0: no proof");
  if (const std::string prior = choice_of(values, "prior", {"none", "tolerance"}); !prior.empty())
    plan_options.prior = prior == "tolerance";
  if (const std::string scaling = choice_of(values, "scaling", {"tolerance", "norm", "none"}); !scaling.empty())
    plan_options.scaling = scaling_of(scaling);
  const std::filesystem::path list = text_of(values, "candidates-from");
  if (!list.empty() && plan_options.candidates)
    throw InputError({}, "--candidates and --candidates-from cannot be combined", "leave one of them out");
  const std::filesystem::path augment = text_of(values, "augment"), fixed = text_of(values, "fixed");
  plan_options.reserve = values.count("reserve") > 0;
  plan_options.robust = robust_spec(whole_number(values, "robust", least_robust_draws, most_robust_draws),
                                    text_of(values, "robust-measure"), "--robust-measure");
  plan_options.seed = common.seed;
  plan_options.threads = common.threads;
  const Problem problem = given_problem(file, values);
  if (!list.empty() || !augment.empty() || !fixed.empty()) {
    const std::vector<Coordinate> coordinates = pose_coordinates(problem, plan_options.variant);
    if (!augment.empty()) plan_options.measured = read_poses(augment, without_limits(coordinates));
    if (!fixed.empty()) plan_options.fixed = read_poses(fixed, coordinates);
    if (!list.empty()) plan_options.candidates_from = read_poses(list, without_limits(coordinates));
  }
  std::vector<std::filesystem::path> inputs = files_of(problem);
  if (!augment.empty()) inputs.push_back(augment);
  if (!fixed.empty()) inputs.push_back(fixed);
  if (!list.empty()) inputs.push_back(list);
  const std::optional<int> validation = whole_number(values, "validation", 1, 1000000);
  const auto engine = engine_of(values, "plan");
  const Outputs outputs(values, inputs, true, validation.has_value());
  std::function<Plan(const Plan&, const Monitor&)> validate;
  if (validation)
    validate = [&](const Plan& plan, const Monitor& monitor) {
      return plan_validation(problem, plan_options, plan, *validation, monitor);
    };
  return outputs.search_and_write(
      common, time_limit(values), [&](const Monitor& monitor) { return plan_problem(problem, plan_options, monitor); },
      validate, engine.get());
}

}  // namespace

Command plan_command() {
  return {"plan",
          "PROBLEM",
          "Searches for the poses to measure; writes the plan and the pose list.",
          plan_command_options,
          "posewright plan examples/kr270/problem.yaml --poses 18 -o plan.json --poses-csv poses.csv",
          run_plan,
          true};
}

}  // namespace posewright::cli
