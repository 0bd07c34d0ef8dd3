#include <fmt/format.h>

#include "command.hpp"
#include "design_options.hpp"
#include "posewright/controller/known_controllers.hpp"
#include "posewright/lists/pose_document.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/outputs/pose_formats.hpp"
#include "posewright/results/evaluation.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

DesignOptions evaluate_keys() { return {"variant", "truth", "criterion", "method", "candidates", "restarts"}; }

po::options_description evaluate_command_options() {
  po::options_description options("Options");
  options.add_options()                                            //
      ("drop", text("k"), "suggest k poses to leave out")          //
      ("add", text("k"), "suggest k additional poses")             //
      ("time-limit", text("S"), "stop searching after S seconds")  //
      ("from", text("FORMAT"),
       ("format of POSES: " + readable_format_names() + "; of programs: " + program_format_names()).c_str())  //
      ("controller", text("NAME"),
       "controller of programs: known name, or YAML file with sign, zero_deg, range_deg, …")  //
      ("coupling", text("F"), "programs: J3 of the controller is J3 - F*J2 of the robot; 0: no coupling");
  add_design_options(options, evaluate_keys());
  options.add(problem_options());
  return options;
}

PoseList given_poses(const po::variables_map& values, const std::string& file,
                     const std::vector<Coordinate>& coordinates) {
  DocumentOptions options;
  options.format = text_of(values, "from");
  const std::string controller = text_of(values, "controller");
  const auto coupling = number_between(values, "coupling", -10, 10);
  if (!is_program_format(options.format) || options.format == "joint-trajectory") {
    if (!controller.empty() || coupling)
      throw InputError({}, "--controller and --coupling are for programs", "--from " + program_format_names());
    return read_poses(file, coordinates, options.format);
  }
  if (!controller.empty()) options.controller = controller_settings(controller);
  if (coupling) options.coupling = *coupling;
  PoseList poses = program_poses(file, coordinates, options);
  return poses;
}

int run_evaluate(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  if (positional.size() != 2)
    throw InputError({}, "two arguments are needed: PROBLEM POSES", "see posewright help evaluate");
  EvaluateOptions evaluate;
  evaluate.drop = whole_number(values, "drop", 1, 1000000);
  evaluate.add = whole_number(values, "add", 1, 1000000);
  const std::string from = text_of(values, "from");
  if (!from.empty() && !is_program_format(from)) find_readable_format(from, program_format_names());
  evaluate.run.seed = common.seed;
  evaluate.run.threads = common.threads;
  const Problem problem = designed_problem(positional[0], values, evaluate_keys());
  const PoseList poses = given_poses(values, positional[1], pose_coordinates(problem));
  const auto [result, was_interrupted] = watched(common, time_limit(values), [&](const Monitor& monitor) {
    return evaluate_problem(problem, poses, evaluate, monitor);
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
