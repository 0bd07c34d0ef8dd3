#include <fmt/format.h>

#include "calibration_report.hpp"
#include "command.hpp"
#include "posewright/version.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

using Json = nlohmann::ordered_json;

po::options_description options() {
  po::options_description options("Options");
  options.add_options()                                                                      //
      ("variant", text("V"), "which variant is calibrated (design: variant, or the first)")  //
      ("weights", text("KIND"),
       "ols: all readings of a unit alike; wls: by the instrument's noise; robust: gross errors lose their weight "
       "(wls)")                                                                                //
      ("prior", "count tolerances as measurements of their parameters (as the problem says)")  //
      ("validate", text("FILE"), "more data, not fitted, to judge the result by")              //
      ("hold-back", text("K"), "do not fit every K-th pose, judge the result by it");
  options.add(problem_options());
  return options;
}

CalibrateOptions options_of(const po::variables_map& values, const Words& positional) {
  if (positional.size() < 2)
    throw InputError({}, positional.empty() ? "PROBLEM is missing" : "DATA.csv is missing",
                     "see posewright help calibrate");
  if (positional.size() > 2) throw InputError({}, "unexpected argument '" + positional[2] + "'", "PROBLEM DATA.csv");
  CalibrateOptions calibrate;
  calibrate.data = positional[1];
  calibrate.variant = text_of(values, "variant");
  const std::string weights = choice_of(values, "weights", {"ols", "wls", "robust"});
  if (weights == "ols") calibrate.weighting = Weighting::ordinary;
  if (weights == "robust") calibrate.weighting = Weighting::robust;
  calibrate.prior = values.count("prior") > 0;
  calibrate.validate = text_of(values, "validate");
  calibrate.hold_back = whole_number(values, "hold-back", 2, 1000000).value_or(0);
  return calibrate;
}

int run(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const CalibrateOptions calibrate = options_of(values, positional);
  const Problem problem = given_problem(positional.front(), values);
  const Calibration result =
      watched(common, 0, [&](const Monitor& monitor) { return calibrate_problem(problem, calibrate, monitor); }).result;
  print_notes(result.notes);
  if (!common.json) {
    print_report(calibration_text(result));
    return result.fit.converged ? done : cannot_do;
  }
  Json json = {{"schema", "posewright/calibration/1"},
               {"version", version},
               {"problem", problem_json(problem)},
               {"data", calibrate.data.string()}};
  json.update(calibration_json(result));
  fmt::print("{}\n", json.dump(1));
  return result.fit.converged ? done : cannot_do;
}

}  // namespace

Command calibrate_command() {
  return {"calibrate",
          "PROBLEM DATA.csv",
          "Estimates a variant's parameters from measured data: values, intervals, residuals, tests of the model.",
          options,
          "posewright calibrate problem.yaml measured.csv --validate more.csv",
          run};
}

}  // namespace posewright::cli
