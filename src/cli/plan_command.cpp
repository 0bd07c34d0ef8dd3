#include "command.hpp"
#include "design_options.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "problem_source.hpp"
#include "task_options.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

DesignOptions plan_keys() {
  return {"poses",   "variant", "truth",   "criterion", "method",  "candidates", "candidates-from", "restarts",
          "repeats", "scaling", "augment", "fixed",     "reserve", "robust",     "robust-measure",  "prior"};
}

po::options_description plan_command_options() {
  po::options_description options("Options");
  add_design_options(options, plan_keys());
  options.add_options()  //
      ("validation", text("k"), "k additional poses for validation: plan-validation.json, poses-validation.csv")(
          "gap", text("P"), "stop the workspace proof at this gap, in percent (0.1)")(
          "proof-time", text("S"),
          "time limit of the workspace proof in seconds; 0: no proof (an amount of work, some seconds)");
  options.add(output_options(true)).add(resume_option());
  options.add(problem_options());
  return options;
}

int run_plan(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  RunOptions run;
  if (const auto gap = number_below(values, "gap", 100, "percent, above 0 and below 100, are allowed"))
    run.proof.gap = *gap / 100;
  run.proof.seconds = text_of(values, "proof-time") == "0"
                          ? 0.0
                          : number_below(values, "proof-time", 1e9, "a number of seconds is allowed; 0: no proof");
  run.seed = common.seed;
  run.threads = common.threads;
  const Problem problem = designed_problem(single(positional, "PROBLEM"), values, plan_keys());
  const std::optional<int> validation = whole_number(values, "validation", 1, 1000000);
  const auto engine = engine_of(values, "plan");
  const Outputs outputs(values, files_of(problem), true, validation.has_value());
  std::function<Plan(const Plan&, const Monitor&)> validate;
  if (validation)
    validate = [&](const Plan& plan, const Monitor& monitor) {
      return plan_validation(problem, run, plan, *validation, monitor);
    };
  return outputs.search_and_write(
      common, time_limit(values), [&](const Monitor& monitor) { return plan_problem(problem, run, monitor); }, validate,
      engine.get());
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
