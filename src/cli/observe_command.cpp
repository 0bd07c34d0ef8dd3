#include <fmt/format.h>

#include "command.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/observation.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

po::options_description observe_command_options() { return described(observe_options()).add(problem_options()); }

int run_observe(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const Problem problem = given_problem(single(positional, "PROBLEM"), values);
  ObserveOptions observe;
  read_options(observe_options(), values, observe);
  const auto [observations, was_interrupted] =
      watched(common, 0, [&](const Monitor& monitor) { return observe_problem(problem, observe, monitor); });
  // A shortened pool would be shown as if it were whole.
  if (was_interrupted) return interrupted;
  if (common.json) {
    fmt::print("{}", json_text(observations_json(problem, observe.seed, observations)));
    return done;
  }
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (i > 0) fmt::print("\n");
    print_report(observation_text(observations[i], values.count("spectrum") > 0));
  }
  return done;
}

}  // namespace

Command observe_command() {
  return {"observe",
          "PROBLEM",
          "Analyses identifiability: rank, dependencies, smallest number of poses, parameters worth identifying.",
          observe_command_options,
          "posewright observe examples/telescope/problem.yaml",
          run_observe};
}

}  // namespace posewright::cli
