#include <fmt/format.h>

#include "command.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/simulation.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/simulate_problem.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description simulate_command_options() {
  return described(simulate_options()).add(task_options()).add(problem_options());
}

int run_simulate(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  if (positional.size() != 2)
    throw InputError({}, "two arguments are needed: PROBLEM PLAN", "see posewright help simulate");
  SimulateOptions simulate;
  read_options(simulate_options(), values, simulate);
  const std::string from = text_of(values, "from");
  if (!from.empty()) find_readable_format(from);
  const std::filesystem::path data = output_file(values, "data");
  const Problem problem = given_problem(positional[0], values);
  std::vector<std::filesystem::path> inputs = files_of(problem);
  inputs.emplace_back(positional[1]);
  check_output_files(values, {data}, inputs);
  const auto engine = engine_of(values, "simulate");
  const PoseList poses = read_poses(positional[1], pose_coordinates(problem, simulate.variant), from);
  const auto [result, was_interrupted] = watched(
      common, 0, [&](const Monitor& monitor) { return simulate_problem(problem, poses, simulate, monitor); },
      engine.get());
  print_notes(result.notes);
  if (!data.empty()) write_results({{data, result.first_readings}});
  if (common.json) fmt::print("{}", json_text(simulation_json(problem, simulate, result)));
  else print_report(simulation_text(result, simulate) + written_text({data}));
  return was_interrupted ? interrupted : done;
}

}  // namespace

Command simulate_command() {
  return {"simulate",
          "PROBLEM PLAN",
          "Simulates the measurement of a plan on random robots, calibrates, compares with truth and prediction.",
          simulate_command_options,
          "posewright simulate examples/kr270/problem.yaml plan.json --draws 5000",
          run_simulate,
          true};
}

}  // namespace posewright::cli
