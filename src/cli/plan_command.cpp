#include "command.hpp"
#include "design_options.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

DesignOptions plan_keys() {
  return {"poses",   "variant", "truth",   "criterion", "method",  "candidates", "candidates-from", "restarts",
          "repeats", "scaling", "augment", "fixed",     "reserve", "robust",     "robust-measure",  "prior"};
}

po::options_description plan_command_options() {
  po::options_description options = described(plan_options());
  add_design_options(options, plan_keys());
  return options.add(output_options(true)).add(resume_option()).add(problem_options());
}

int run_plan(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  PlanCall call;
  read_options(plan_options(), values, call);
  call.run.other_numbers = true;
  const Problem problem = designed_problem(single(positional, "PROBLEM"), values, plan_keys());
  const auto engine = engine_of(values, "plan");
  const Outputs outputs(values, files_of(problem), true, call.validation.has_value());
  std::function<Plan(const Plan&, const Monitor&)> validate;
  if (call.validation)
    validate = [&](const Plan& plan, const Monitor& monitor) {
      return plan_validation(problem, call.run, plan, *call.validation, monitor);
    };
  return outputs.search_and_write(
      common, time_limit(values), [&](const Monitor& monitor) { return plan_problem(problem, call.run, monitor); },
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
