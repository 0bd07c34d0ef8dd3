#include <fmt/format.h>

#include "command.hpp"
#include "design_options.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/evaluation.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

DesignOptions evaluate_keys() { return {"variant", "truth", "criterion", "method", "candidates", "restarts"}; }

po::options_description evaluate_command_options() {
  po::options_description options = described(evaluate_options());
  options.add_options()("time-limit", text("S"), "stop searching after S seconds");
  add_design_options(options, evaluate_keys());
  return options.add(problem_options());
}

int run_evaluate(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  if (positional.size() != 2)
    throw InputError({}, "two arguments are needed: PROBLEM POSES", "see posewright help evaluate");
  EvaluateCall call;
  read_options(evaluate_options(), values, call);
  const Problem problem = designed_problem(positional[0], values, evaluate_keys());
  const PoseList poses = poses_to_evaluate(positional[1], pose_coordinates(problem), call.reading);
  const auto [result, was_interrupted] = watched(common, time_limit(values), [&](const Monitor& monitor) {
    return evaluate_problem(problem, poses, call.options, monitor);
  });
  print_notes(result.notes);
  if (common.json) fmt::print("{}", json_text(evaluation_json(result)));
  else print_report(evaluation_text(result));
  return was_interrupted ? interrupted : done;
}

}  // namespace

Command evaluate_command() {
  return {"evaluate",
          "PROBLEM POSES",
          "Scores given poses (CSV or plan.json): every criterion, each pose's share, poses to drop and to add.",
          evaluate_command_options,
          "posewright evaluate examples/telescope/problem.yaml poses.csv --drop 2 --add 3",
          run_evaluate};
}

}  // namespace posewright::cli
