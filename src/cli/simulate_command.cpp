#include <fmt/format.h>

#include <charconv>

#include "command.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/outputs/pose_formats.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/results/simulation.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/json.hpp"
#include "problem_source.hpp"
#include "result_files.hpp"
#include "session.hpp"
#include "task_options.hpp"
#include "terminal.hpp"
#include "weighting.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description simulate_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                                          //
      ("draws", text("n"), "virtual calibrations (1000)")                                                        //
      ("truth", text("V"), "variant that generates the readings (the calibrated one)")                           //
      ("truth-nominal", "truth with other nominal values only")                                                  //
      ("truth-repeatability", text("LENGTH"), "random offset of the tip at each visit, 1σ (as in the problem)")  //
      ("truth-independent", text("LENGTH"), "random offset of every single target, 1σ (0)")                      //
      ("truth-joints", text("ANGLE"), "error of the simulated robot's joint readings, 1σ (as in the problem)")   //
      ("no-prior", "plain least squares: calibrate without manufacturing tolerances as prior knowledge")         //
      ("exact", "true parameters equal the nominal ones, without random errors")                                 //
      ("profile", "check intervals by profile likelihood too: one more fit per parameter and draw")              //
      ("variant", text("V"), "model variant to calibrate (design: variant, else the first)")                     //
      ("weights", text("ols|wls|robust"), "weights: equal, by noise, or small for gross errors (wls)")           //
      ("missing", text("SHARE"), "share of missing targets (0)")                                                 //
      ("outliers", text("SHARE"), "share of the targets with a gross error (0)")                                 //
      ("outlier-size", text("k"), "size of a gross error, in σ of its target (20)")                              //
      ("validation", text("k"), "number of random validation poses, if there are no test poses (50)")            //
      ("candidates", text("n"),
       "configurations for choosing the parameters of auto (as plan)")                  //
      ("from", text("FORMAT"), ("format of PLAN: " + readable_format_names()).c_str())  //
      ("data", text("FILE"), "write the readings of the first draw, for calibrate")     //
      ("force", "replace a file that posewright did not write");
  options.add(task_options()).add(problem_options());
  return options;
}

double number(const po::variables_map& values, const std::string& option, double standard, double lower, double upper) {
  const std::string text = text_of(values, option);
  if (values.count(option) == 0) return standard;
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !(value >= lower) || !(value <= upper))
    throw InputError({}, "--" + option + " " + text, fmt::format("a number from {} to {} is allowed", lower, upper));
  return value;
}

/// A size with its unit.
std::optional<Measured> size(const po::variables_map& values, const char* option,
                             std::initializer_list<Quantity> quantities) {
  if (values.count(option) == 0) return std::nullopt;
  const std::string text = text_of(values, option);
  const auto refuse = [&] {
    throw InputError({}, fmt::format("--{} {}", option, text),
                     "a value >= 0 with its unit is expected: " + allowed_units(quantities));
  };
  Measured given;
  try {
    given = parse_measured(text, quantities);
  } catch (const InputError&) {
    refuse();
  }
  if (!(given.value >= 0) || (given.quantity == Quantity::number && given.value > 0)) refuse();
  return given;
}

SimulateOptions options_of(const po::variables_map& values, const CommonOptions& common) {
  SimulateOptions simulate;
  ExperimentOptions& experiment = simulate.experiment;
  simulate.variant = text_of(values, "variant");
  simulate.truth = text_of(values, "truth");
  simulate.truth_nominal = values.count("truth-nominal") > 0;
  if (const auto given = size(values, "truth-repeatability", {Quantity::length}))
    simulate.truth_noise.repeatability = given->value;
  if (const auto given = size(values, "truth-independent", {Quantity::length}))
    simulate.truth_noise.independent = given->value;
  simulate.truth_noise.joints = size(values, "truth-joints", {Quantity::angle, Quantity::length});
  if (simulate.truth_nominal && simulate.truth.empty())
    throw InputError({}, "--truth-nominal needs another variant", "--truth V");
  experiment.draws = whole_number(values, "draws", 2, 10000000).value_or(experiment.draws);
  experiment.exact = values.count("exact") > 0;
  experiment.missing = number(values, "missing", 0, 0, 0.9);
  experiment.outliers = number(values, "outliers", 0, 0, 1);
  experiment.outlier_size = number(values, "outlier-size", experiment.outlier_size, 0, 1e9);
  if (values.count("outlier-size") > 0 && experiment.outliers == 0)
    throw InputError({}, "--outlier-size without outliers", "--outliers SHARE");
  experiment.fit.weighting = weighting_of(values);
  experiment.fit.prior = values.count("no-prior") > 0 ? Prior::none : Prior::manufactured;
  experiment.profile = values.count("profile") > 0;
  experiment.seed = common.seed;
  experiment.threads = common.threads;
  simulate.validation = whole_number(values, "validation", 1, 1000000).value_or(simulate.validation);
  simulate.candidates = whole_number(values, "candidates", 1, 10000000);
  return simulate;
}

int run_simulate(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  if (positional.size() != 2)
    throw InputError({}, "two arguments are needed: PROBLEM PLAN", "see posewright help simulate");
  const SimulateOptions simulate = options_of(values, common);
  const std::string from = text_of(values, "from");
  if (!from.empty()) find_readable_format(from);
  const std::filesystem::path data = values.count("data") > 0 ? output_file(values, "data", "") : "";
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
