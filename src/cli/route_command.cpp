#include <fmt/format.h>

#include "command.hpp"
#include "packages.hpp"
#include "posewright/outputs/pose_formats.hpp"
#include "posewright/outputs/route.hpp"
#include "posewright/pipeline/route_problem.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/file.hpp"
#include "session.hpp"

namespace posewright::cli {
namespace {

po::options_description options() {
  po::options_description options("Options");
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  options.add_options()                                                                      //
      ("from-home", "begin at home (workspace: motion: home, else zero)")                    //
      ("closed", "end where the route began")                                                //
      ("start", text("ID"), "pose to begin with")                                            //
      ("problem", text("FILE"), "problem file (the one the plan names)")                     //
      ("milestones", text("n"), "of the roadmap for motions that cannot be straight (200)")  //
      ("output,o", text("FILE"), "route as JSON (route.json; - for none)")                   //
      ("poses-csv", text("FILE"), "poses in measuring order as CSV (none)")                  //
      ("force", "replace files that posewright did not write")                               //
      ("time-limit", text("S"), "give up after S seconds")                                   //
      ("from", text("FORMAT"), ("format of PLAN where it is none: " + readable_format_names()).c_str());
  options.add(package_options());
  return options;
}

int run(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const std::filesystem::path plan = single(positional, "PLAN");
  RouteOptions route_options;
  route_options.from = text_of(values, "from");
  if (!route_options.from.empty()) find_readable_format(route_options.from);
  route_options.from_home = values.count("from-home") > 0;
  route_options.closed = values.count("closed") > 0;
  route_options.start = whole_number(values, "start", 1, 1000000);
  route_options.milestones = whole_number(values, "milestones", 1, 100000).value_or(200);
  route_options.seed = common.seed;
  route_options.threads = common.threads;
  if (route_options.from_home && route_options.start)
    throw InputError({}, "--start stands beside --from-home", "one of both is allowed");
  const std::filesystem::path given = text_of(values, "problem");
  if (given.empty() && !route_options.from.empty())
    throw InputError({plan.string(), 0}, "names no problem file", "give it with --problem FILE");
  const std::filesystem::path file = given.empty() ? problem_of_plan(plan) : given;
  Problem problem = read_problem(file);
  problem.packages = packages_of(values);
  std::filesystem::path json = values.count("output") > 0 ? text_of(values, "output") : "route.json";
  std::filesystem::path csv = text_of(values, "poses-csv");
  std::vector<std::filesystem::path> outputs;
  for (auto* output : {&json, &csv}) {
    if (*output == "-") output->clear();
    if (!output->empty()) outputs.push_back(*output);
  }
  check_outputs(outputs, {plan, file}, values.count("force") > 0);
  Route route;
  {
    const Watch watch(common, time_limit(values));
    try {
      route = route_problem(problem, plan, route_options, watch.monitor());
    } catch (const CannotDo&) {
      if (watch.was_interrupted()) return interrupted;
      throw;
    }
  }
  print_notes(route.notes);
  if (!json.empty()) write_file_atomically(json, route_json(route));
  if (!csv.empty()) write_file_atomically(csv, route_csv(route));
  if (common.json) {
    fmt::print("{}", route_json(route));
  } else {
    fmt::print("{}", route_summary(route));
    if (!outputs.empty()) {
      std::string names;
      for (const auto& output : outputs) names += (names.empty() ? "" : ", ") + output.string();
      fmt::print("Written: {}\n", names);
    }
  }
  return done;
}

}  // namespace

Command route_command() {
  return {"route",
          "PLAN",
          "Puts the poses of a plan in the order that takes least time, with collision-free motions between them.",
          options,
          "posewright route plan.json --from-home --closed -o route.json",
          run};
}

}  // namespace posewright::cli
