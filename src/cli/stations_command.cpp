#include <fmt/format.h>

#include "command.hpp"
#include "design_options.hpp"
#include "posewright/outputs/table.hpp"
#include "posewright/results/stations.hpp"
#include "posewright/support/json.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "task_options.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

DesignOptions stations_keys() { return {"poses", "variant", "criterion", "candidates", "restarts"}; }

po::options_description stations_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                                      //
      ("choose", text("k"), "number of stations to use (workspace: stations: choose, 1)")                    //
      ("pairs", "score every pair of places; without it, beyond 100 pairs, only pairs with the best place")  //
      ("full", text("n"), "number of best places that get a full plan (3)")                                  //
      ("time-limit", text("S"), "stop after S seconds with the results so far");
  add_design_options(options, stations_keys());
  options.add(task_options()).add(problem_options());
  return options;
}

int run_stations(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  StationOptions stations;
  stations.choose = whole_number(values, "choose", 1, 100);
  stations.full = whole_number(values, "full", 0, 10000).value_or(3);
  stations.run.seed = common.seed;
  stations.run.threads = common.threads;
  stations.every_set = values.count("pairs") > 0;
  if (stations.every_set) {
    if (stations.choose) throw InputError({}, "--choose and --pairs cannot be combined", "one of them");
    stations.choose = 2;
  }
  const auto engine = engine_of(values, "stations");
  const Problem problem = designed_problem(single(positional, "PROBLEM"), values, stations_keys());
  const auto [ranks, was_interrupted] = watched(
      common, time_limit(values), [&](const Monitor& monitor) { return place_stations(problem, stations, monitor); },
      engine.get());
  if (common.json) fmt::print("{}", json_text(stations_json(problem, stations, ranks)));
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
