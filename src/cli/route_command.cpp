#include <fmt/format.h>

#include "command.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/route.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description route_command_options() { return described(route_options()).add(problem_options()); }

int run_route(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const std::filesystem::path plan = single(positional, "PLAN");
  RouteOptions options;
  const std::string from = text_of(values, "from");
  if (!from.empty()) find_readable_format(from);
  read_options(route_options(), values, options);
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
    return route_problem(problem, poses, options, monitor);
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
                   (options.replace ? "" : "; --replace takes the next best poses in their place"));
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
