#include <fmt/format.h>

#include "command.hpp"
#include "design_options.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/stations.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/place_stations.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

DesignOptions stations_keys() { return {"poses", "variant", "criterion", "candidates", "restarts"}; }

po::options_description stations_command_options() {
  po::options_description options = described(station_options());
  options.add_options()("time-limit", text("S"), "stop after S seconds with the results so far");
  add_design_options(options, stations_keys());
  return options.add(task_options()).add(problem_options());
}

int run_stations(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  StationOptions stations;
  read_options(station_options(), values, stations);
  const auto engine = engine_of(values, "stations");
  const Problem problem = designed_problem(single(positional, "PROBLEM"), values, stations_keys());
  const auto [ranks, was_interrupted] = watched(
      common, time_limit(values), [&](const Monitor& monitor) { return place_stations(problem, stations, monitor); },
      engine.get());
  if (common.json)
    fmt::print("{}", json_text(stations_json(problem, stations.run.seed, criterion_of_places(problem), ranks)));
  else print_report(stations_text(ranks));
  return was_interrupted ? interrupted : done;
}

}  // namespace

Command stations_command() {
  return {"stations",
          "PROBLEM",
          "Ranks places for the instrument by the best plan from each place.",
          stations_command_options,
          "posewright stations examples/cell/problem.yaml --choose 1",
          run_stations,
          true};
}

}  // namespace posewright::cli
