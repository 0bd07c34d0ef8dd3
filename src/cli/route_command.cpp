#include <fmt/format.h>

#include "command.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/outputs/pose_formats.hpp"
#include "posewright/outputs/route.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "problem_source.hpp"
#include "result_files.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description route_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                              //
      ("from-home", "begin at home (workspace: motion: home, else zero)")                            //
      ("closed", "return to the start at the end")                                                   //
      ("start", text("ID"), "pose to begin with")                                                    //
      ("problem", text("FILE"), "problem file (the one named by the plan)")                          //
      ("replace", "take the next best poses in place of those that no motion reaches")               //
      ("milestones", text("n"), "configurations in the roadmap for motions around obstacles (200)")  //
      ("settle", text("S"), "seconds at rest before a pose is read (workspace: motion: settle, 0)")  //
      ("reading", text("S"),
       "seconds of one reading; per target, where targets are read in turn (workspace: motion: reading, 0)")  //
      ("output,o", text("FILE"), "route as JSON (route.json; - for none)")                                    //
      ("poses-csv", text("FILE"), "poses in measuring order as CSV (none)")                                   //
      ("force", "replace files that posewright did not write")                                                //
      ("time-limit", text("S"), "stop after S seconds with the best order so far")                            //
      ("from", text("FORMAT"), ("format of PLAN if it is not a plan: " + readable_format_names()).c_str());
  options.add(problem_options());
  return options;
}

int run_route(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const std::filesystem::path plan = single(positional, "PLAN");
  RouteOptions route_options;
  const std::string from = text_of(values, "from");
  if (!from.empty()) find_readable_format(from);
  route_options.from_home = values.count("from-home") > 0;
  route_options.closed = values.count("closed") > 0;
  route_options.replace = values.count("replace") > 0;
  route_options.start = whole_number(values, "start", 1, 1000000);
  route_options.milestones = whole_number(values, "milestones", 1, 100000).value_or(200);
  route_options.settle = number_between(values, "settle", 0, 3600);
  route_options.reading = number_between(values, "reading", 0, 3600);
  route_options.seed = common.seed;
  route_options.threads = common.threads;
  if (route_options.from_home && route_options.start)
    throw InputError({}, "--start and --from-home cannot be combined", "leave one of them out");
  if (!from.empty() && text_of(values, "problem").empty())
    throw InputError({plan.string(), 0}, "names no problem file", "give it with --problem FILE");
  const std::filesystem::path file = problem_file(values, plan);
  const Problem problem = problem_for_plan(file, values, plan);
  const std::filesystem::path json = output_file(values, "output", "route.json");
  const std::filesystem::path csv = output_file(values, "poses-csv", "-");
  std::vector<std::filesystem::path> inputs = files_of(problem);
  inputs.push_back(plan);
  check_output_files(values, {json, csv}, inputs);
  const PoseList poses = read_poses(plan, pose_coordinates(problem), from);
  const auto [route, was_interrupted] = watched(common, time_limit(values), [&](const Monitor& monitor) {
    return route_problem(problem, poses, route_options, monitor);
  });
  print_notes(route.notes);
  std::vector<FileToWrite> files;
  if (!csv.empty()) files.push_back({csv, route_csv(route)});
  const std::string text = route_json(route, json.empty() ? std::vector<WrittenWith>() : written_with(json, files));
  if (!json.empty()) files.push_back({json, text});
  write_results(files);
  if (common.json) fmt::print("{}", text);
  else print_report(route_summary(route) + written_text({json, csv}));
  if (was_interrupted) return interrupted;
  if (!route.unreachable.empty())
    throw CannotDo(plan.string() + ": " + route_loss(route) +
                   (route_options.replace ? "" : "; --replace takes the next best poses in their place"));
  return done;
}

}  // namespace

Command route_command() {
  return {"route",
          "PLAN",
          "Orders the poses of a plan for the shortest time, with collision-free motions between them.",
          route_command_options,
          "posewright route plan.json --from-home --closed -o route.json",
          run_route};
}

}  // namespace posewright::cli
