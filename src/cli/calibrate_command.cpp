#include <fmt/format.h>

#include <algorithm>

#include "command.hpp"
#include "posewright/lists/compliance_list.hpp"
#include "posewright/model/corrected_urdf.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/calibrated_dh_table.hpp"
#include "posewright/results/calibration.hpp"
#include "posewright/results/next.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/model_choice.hpp"
#include "posewright/tasks/next_poses.hpp"
#include "posewright/tasks/samples_problem.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description calibrate_command_options() { return described(calibrate_options()).add(problem_options()); }

/// The problem that `init --samples` writes. Wrong samples get small weights unless the weights are stated.
Problem problem_of_samples(const std::filesystem::path& file, const po::variables_map& values,
                           CalibrateOptions& calibrate) {
  const SamplesProblem found = samples_problem(file, {});
  print_notes(found.notes);
  if (!found.wrong.empty() && values.count("weights") == 0) calibrate.weighting = Weighting::robust;
  return parse_problem(found.text, "problem of " + file.filename().string(), {});
}

/// Output files for users of the robot.
struct Results {
  std::filesystem::path parameters, urdf, deformation;  ///< empty: not asked for
  std::optional<DhConvention> dh;

  Results(const po::variables_map& values, const Problem& problem, const CalibrateCall& calibrate)
      : parameters(output_file(values, "output")),
        urdf(output_file(values, "urdf")),
        deformation(output_file(values, "deformation")),
        dh(calibrate.dh) {
    if ((!urdf.empty() || dh) && std::get_if<SerialArmSpec>(&problem.robot) == nullptr)
      throw InputError({}, urdf.empty() ? "--dh is for serial arms" : "--urdf is for serial arms", "robot: urdf");
    if (dh && !std::get<SerialArmSpec>(problem.robot).ways.empty())
      throw InputError({}, "--dh is for an arm whose instruments see one tip", "base and tip in place of tips");
    std::vector<std::filesystem::path> inputs = files_of(problem);
    inputs.push_back(calibrate.data);
    inputs.insert(inputs.end(), calibrate.campaigns.begin(), calibrate.campaigns.end());
    if (!calibrate.validate.empty()) inputs.push_back(calibrate.validate);
    check_output_files(values, {parameters, urdf, deformation}, inputs);
  }
};

/// The robot's files; what a URDF cannot say goes to `notes`.
std::vector<FileToWrite> files_to_write(const Results& wanted, const Problem& problem, const Calibration& result,
                                        std::vector<std::string>& notes) {
  std::vector<FileToWrite> files;
  const VariantSpec& variant = find_variant(problem, result.variant);
  if (!wanted.urdf.empty()) {
    const auto& arm = std::get<SerialArmSpec>(problem.robot);
    const CorrectedUrdf urdf = corrected_urdf(arm, problem.at(arm.line), variant.convention, estimated_values(result));
    for (const std::string& left_out : urdf.left_out) notes.push_back("not in the URDF: " + left_out);
    files.push_back({wanted.urdf, urdf.text});
  }
  if (!wanted.parameters.empty())
    files.push_back({wanted.parameters, parameters_yaml({problem, variant}, result.values, shown_effect(result))});
  return files;
}

CalibrateCall options_of(const po::variables_map& values, const Words& positional) {
  CalibrateCall calibrate;
  if (values.count("samples") > 0) {
    if (!positional.empty()) throw InputError({}, "--samples and " + positional.front(), "one of them");
    calibrate.data = text_of(values, "samples");
  } else {
    if (positional.size() < 2)
      throw InputError({}, positional.empty() ? "PROBLEM is missing" : "DATA.csv is missing",
                       "see posewright help calibrate");
    calibrate.data = positional[1];
    calibrate.campaigns.assign(positional.begin() + 2, positional.end());
  }
  read_options(calibrate_options(), values, calibrate);
  return calibrate;
}

void refuse_results(const Results& wanted, const std::string& why) {
  if (!wanted.parameters.empty() || !wanted.urdf.empty() || wanted.dh || !wanted.deformation.empty())
    throw InputError({}, "-o, --urdf, --dh and --deformation are for one calibration", why);
}

/// Several models of the robot on the same data, beside each other.
int run_models(const CommonOptions& common, const Problem& problem, CalibrateOptions calibrate,
               const std::vector<std::string>& variants) {
  std::vector<Calibration> models;
  for (const std::string& variant : variants) {
    calibrate.variant = find_variant(problem, variant).name;
    models.push_back(watched(common, 0, [&](const Monitor& monitor) {
                       return calibrate_problem(problem, calibrate, monitor);
                     }).result);
  }
  for (const Calibration& model : models)
    for (const std::string& note : model.notes) print_notes({model.variant + ": " + note});
  const ModelChoice choice = choose_model(models);
  if (common.json) {
    fmt::print("{}", json_text(models_json(problem, calibrate, models, choice)));
  } else {
    print_report(models_text(models, choice));
  }
  const bool all = std::all_of(models.begin(), models.end(), [](const Calibration& c) { return c.fit.converged; });
  return all ? done : cannot_do;
}

/// The data are compliances that somebody found: the compensator's constants follow from them.
int run_compliances(const CommonOptions& common, const Problem& problem, const CalibrateOptions& calibrate) {
  const CompensatorConstants found = compensator_of_list(problem.robot, calibrate.data);
  if (common.json) {
    fmt::print("{}", json_text(compensator_json(problem, calibrate, found)));
  } else {
    print_report(compensator_text(found));
  }
  return done;
}

/// The poses to measure after these samples; none, with a note, where they cannot be chosen.
std::optional<NextPoses> next_of_samples(const CommonOptions& common, const Problem& problem,
                                         const CalibrateOptions& calibrate) {
  NextOptions next;
  next.data = calibrate.data;
  next.text = read_file(calibrate.data);
  next.poses = poses_looked_ahead;
  next.prior = calibrate.prior;
  set_run(next, common.seed, common.threads);
  try {
    return watched(common, 0, [&](const Monitor& monitor) { return next_poses(problem, next, monitor); }).result;
  } catch (const CannotDo& why) {
    print_notes({std::string("no poses are proposed: ") + why.what()});
  } catch (const InputError& why) {
    print_notes({std::string("no poses are proposed: ") + why.what()});
  }
  return std::nullopt;
}

int run_calibrate(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  CalibrateCall calibrate = options_of(values, positional);
  const Problem problem = positional.empty() ? problem_of_samples(calibrate.data, values, calibrate)
                                             : given_problem(positional.front(), values);
  const Results wanted(values, problem, calibrate);
  if (calibrate.models.size() > 1) {
    refuse_results(wanted, "a single --variant");
    return run_models(common, problem, calibrate, calibrate.models);
  }
  if (lists_compliances(calibrate.data)) {
    refuse_results(wanted, "data that are readings of the instrument");
    return run_compliances(common, problem, calibrate);
  }
  auto [result, was_interrupted] =
      watched(common, 0, [&](const Monitor& monitor) { return calibrate_problem(problem, calibrate, monitor); });
  const std::optional<DhTable> table = dh_table_of(problem, result, wanted.dh);
  std::vector<FileToWrite> files;
  if (!wanted.deformation.empty()) {
    if (!result.platform)
      throw CannotDo("nothing to draw: the data have no joint centres of a platform (columns leg_1.x, leg_1.y, …)");
    files.push_back({wanted.deformation, platform_svg(*result.platform)});
  }
  const bool useful = result.verdict != Verdict::do_not_use;
  const bool written = useful || (result.fit.converged && values.count("force") > 0);
  if (written)
    for (FileToWrite& file : files_to_write(wanted, problem, result, result.notes)) files.push_back(std::move(file));
  else if (!wanted.parameters.empty() || !wanted.urdf.empty())
    result.notes.emplace_back("no parameters are written: they are not good enough to use");
  // These files do not belong together as a program and its points do: one at a time, each replaces its own.
  for (const FileToWrite& file : files) write_results({file});
  print_notes(result.notes);
  print_notes(result.refusals);
  std::optional<NextPoses> next;
  if (positional.empty() && !was_interrupted) next = next_of_samples(common, problem, calibrate);
  if (!common.json) {
    print_report(calibration_text(result) + (table ? "\n" + dh_table_text(*table) : "") +
                 (next ? "\n" + proposed_text(*next) : "") +
                 written_text(written ? std::vector{wanted.parameters, wanted.urdf, wanted.deformation}
                                      : std::vector{wanted.deformation}));
  } else {
    auto json = calibration_json(problem, calibrate, result, table);
    if (next) json["next"] = proposed_json(*next);
    fmt::print("{}", json_text(json));
  }
  return was_interrupted ? interrupted : written ? done : cannot_do;
}

}  // namespace

Command calibrate_command() {
  return {
      "calibrate",
      "PROBLEM DATA.csv [MORE.csv...]",
      "Estimates a variant's parameters from measured data: values, intervals, residuals, tests of the model. Several "
      "files are campaigns: one robot, and for each file frames that moved (--moved).",
      calibrate_command_options,
      "posewright calibrate problem.yaml measured.csv --validate more.csv",
      run_calibrate};
}

}  // namespace posewright::cli
