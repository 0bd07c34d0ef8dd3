#include "posewright/controller/known_controllers.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/problem/design_specs.hpp"
#include "posewright/report/report_problem.hpp"
#include "posewright/search/search.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/compare_problem.hpp"
#include "posewright/tasks/next_poses.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/place_stations.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "posewright/tasks/select_blocks.hpp"
#include "posewright/tasks/simulate_problem.hpp"

namespace posewright {
namespace {

const char* const replaces = "replace files that posewright did not write";

Weighting weights_of(const GivenOption& given) { return weighting_of(word_of(given, {"ols", "wls", "robust"})); }

}  // namespace

const OptionTable<SimulateOptions>& simulate_options() {
  using S = SimulateOptions;
  return table_filled_by<S>([](OptionTable<S>& t) {
    t.whole(
        "draws", "n", "virtual calibrations", 2, 10'000'000, [](S & o) -> auto& { return o.experiment.draws; });
    t.text("truth", "V", "variant that generates the readings (the calibrated one)", &S::truth);
    t.row({"truth-nominal", "", "truth with other nominal values only", OptionKind::flag},
          [](S& o, const GivenOption& given) {
            if (o.truth.empty()) throw InputError({}, given.name + " needs another variant", "truth: V");
            o.truth_nominal = true;
          });
    const auto length = [](const GivenOption& given) { return size_of(given, {Quantity::length}).value; };
    t.row({"truth-repeatability", "LENGTH", "random offset of the tip at each visit, 1σ (as in the problem)",
           OptionKind::size, "m"},
          [=](S& o, const GivenOption& given) { o.truth_noise.repeatability = length(given); });
    t.row({"truth-independent", "LENGTH", "random offset of every single target, 1σ (0)", OptionKind::size, "m"},
          [=](S& o, const GivenOption& given) { o.truth_noise.independent = length(given); });
    t.row({"truth-joints", "ANGLE", "error of the simulated robot's joint readings, 1σ (as in the problem)",
           OptionKind::size, "rad"},
          [](S& o, const GivenOption& given) {
            o.truth_noise.joints = size_of(given, {Quantity::angle, Quantity::length});
          });
    t.row({"no-prior", "", "plain least squares: calibrate without manufacturing tolerances as prior knowledge",
           OptionKind::flag},
          [](S& o, const GivenOption&) { o.experiment.fit.prior = Prior::none; });
    t.flag(
        "exact", "true parameters equal the nominal ones, without random errors",
        [](S & o) -> auto& { return o.experiment.exact; });
    t.flag(
        "profile", "check intervals by profile likelihood too: one more fit per parameter and draw",
        [](S & o) -> auto& { return o.experiment.profile; });
    t.text("variant", "V", "model variant to calibrate (design: variant, else the first)", &S::variant);
    t.row({"weights", "ols|wls|robust", "weights: equal, by noise, or small for gross errors (wls)"},
          [](S& o, const GivenOption& given) { o.experiment.fit.weighting = weights_of(given); });
    t.number(
        "missing", "SHARE", "share of missing targets", 0, 0.9, [](S & o) -> auto& { return o.experiment.missing; });
    t.number(
        "outliers", "SHARE", "share of the targets with a gross error", 0, 1,
        [](S & o) -> auto& { return o.experiment.outliers; });
    t.row({"outlier-size", "k",
           fmt::format("size of a gross error, in σ of its target ({})", S{}.experiment.outlier_size),
           OptionKind::number},
          [](S& o, const GivenOption& given) {
            if (o.experiment.outliers == 0) throw InputError({}, given.name + " without outliers", "outliers: SHARE");
            o.experiment.outlier_size = number_of(given, 0, 1e9);
          });
    t.whole("validation", "k", "number of random validation poses, if there are no test poses", 1, 1'000'000,
            &S::validation);
    t.whole("candidates", "n", "configurations for choosing the parameters of auto (as plan)", 1, 10'000'000,
            &S::candidates);
    t.row({"from", "FORMAT", "format of PLAN: " + readable_format_names()});
    t.of_program("data", "FILE", "write the readings of the first draw, for calibrate");
    t.of_program("force", "", "replace a file that posewright did not write");
  });
}

const OptionTable<CalibrateCall>& calibrate_options() {
  using C = CalibrateCall;
  return table_filled_by<C>([](OptionTable<C>& t) {
    t.row(
        {"variant", "V", "variant to calibrate (design: variant, or the first); a list A,B compares them in one table",
         OptionKind::list},
        [](C& o, const GivenOption& given) {
          o.models = names_of(given);
          if (o.models.size() == 1) o.variant = o.models.front();
        });
    t.row({"weights", "KIND",
           "ols: equal weights; wls: weights by the instrument's noise; robust: small weights for gross errors (wls)"},
          [](C& o, const GivenOption& given) { o.weighting = weights_of(given); });
    t.row(
        {"no-prior", "", "plain least squares, without manufacturing tolerances as prior knowledge", OptionKind::flag},
        [](C& o, const GivenOption&) { o.prior = Prior::none; });
    t.of_program(
        "samples", "FILE",
        "samples of hand-eye calibration in place of PROBLEM and DATA.csv: easy_handeye2, MoveIt, OpenCV, CSV with "
        "robot.* and pose.*");
    t.text("validate", "FILE", "more measured data, for validation; they are not fitted", &C::validate,
           OptionKind::file);
    t.row({"moved", "WHAT",
           "frames that moved between files: base, as of an instrument; tool, with all that the tip carries; both; "
           "nothing; auto: the base, and the tool if the residuals show it (auto)"},
          [](C& o, const GivenOption& given) {
            o.moved = moved_between(given.text());
            if (o.campaigns.empty()) throw InputError({}, given.name + " with one file", "it is about further files");
          });
    t.whole("hold-back", "K", "keep every K-th pose for validation; it is not fitted", 2, 1'000'000, &C::hold_back);
    t.flag("in-steps", "also estimate base and tool, geometry, and stiffness in turn", &C::in_steps);
    t.row(
        {"profile", "WHICH",
         "intervals by profile likelihood: auto (parameters with a large curvature), none, all, or a list of names and "
         "globs (auto)",
         OptionKind::list},
        [](C& o, const GivenOption& given) {
          o.profile = profile_choice(fmt::format("{}", fmt::join(given.values, ",")));
          if (o.profile.choice == ProfileChoice::named && o.weighting == Weighting::robust)
            throw InputError({}, given.name + " with robust weights", "weights: ols or wls");
        });
    t.flag("interpolate",
           "add the residuals, interpolated between the poses, to predictions (variant with `unmodelled`); left out "
           "unless "
           "cross-validation shows a gain",
           &C::interpolate);
    t.of_program("output,o", "FILE", "calibrated parameters as YAML, for --parameters of other commands");
    t.of_program("deformation", "FILE.svg",
                 "picture of the motion of a platform's joint centres, if the data contain them");
    t.of_program("urdf", "FILE", "the robot's URDF with the calibrated kinematics");
    t.row({"dh", "KIND", "table of Denavit-Hartenberg parameters: distal or proximal (modified)"},
          [](C& o, const GivenOption& given) { o.dh = convention_of(given); });
    t.of_program("force", "",
                 "replace files that posewright did not write; write even an estimate that is not fit for use");
  });
}

const OptionTable<NextOptions>& next_options() {
  using N = NextOptions;
  return table_filled_by<N>([](OptionTable<N>& t) {
    t.row({"data", "FILE", "CSV of the readings so far; rows may be appended (none: no pose is measured yet)",
           OptionKind::file},
          [](N& o, const GivenOption& given) {
            if (given.text().empty()) throw InputError({}, given.name + " is empty", "name a file");
            o.data = given.text();
          });
    t.whole("poses,k", "k", "number of next poses", 1, 1000, &N::poses);
    t.row({"required", "LENGTH", "required error at the test poses (design: require: accuracy)", OptionKind::size, "m"},
          [](N& o, const GivenOption& given) { o.required = size_of(given, {Quantity::length}, true).value; });
    t.of_program("watch", "",
                 "repeat whenever the file grows, until the requirement is met, the curve is flat, or Ctrl-C");
    t.text("variant", "V", "model variant to fit (design: variant, else the first)", &N::variant);
    t.row({"criterion", "NAME", "criterion for the next poses: " + criterion_names() + ", auto (the problem's)"},
          [](N& o, const GivenOption& given) {
            o.criterion = given.text();
            if (o.criterion != automatic_criterion) require_known(o.criterion, "auto", {}, {}, automatic_criterion);
          });
    t.row({"no-prior", "", "fit without manufacturing tolerances as prior knowledge", OptionKind::flag},
          [](N& o, const GivenOption&) { o.prior = Prior::none; });
    t.whole("candidates", "n", fmt::format("feasible configurations to choose from ({})", default_candidates).c_str(),
            1, 10'000'000, &N::candidates);
    t.row({"candidates-from", "POSES", "choose among these configurations instead (CSV, plan.json, measured data)",
           OptionKind::poses});
    t.row({"state", "FILE",
           "file that keeps the state between calls (DATA.next-state.json beside the data; - for none)",
           OptionKind::file});
    t.row({"restart", "", "discard the state, after a change of problem or data file", OptionKind::flag});
    t.of_program("output,o", "FILE", "next poses as CSV");
    t.of_program("result", "FILE", "file for the output of --json, rewritten at every step");
    t.of_program("force", "", replaces);
  });
}

const OptionTable<RouteOptions>& route_options() {
  using R = RouteOptions;
  return table_filled_by<R>([](OptionTable<R>& t) {
    t.flag("from-home", "begin at home (workspace: motion: home, else zero)", &R::from_home);
    t.flag("closed", "return to the start at the end", &R::closed);
    t.row({"start", "ID", "pose to begin with", OptionKind::whole}, [](R& o, const GivenOption& given) {
      if (o.from_home) throw InputError({}, given.name + " and from-home cannot be combined", "leave one of them out");
      o.start = whole_of(given, 1, 1'000'000);
    });
    t.of_program("problem", "FILE", "problem file (the one named by the plan)");
    t.flag("replace", "take the next best poses in place of those that no motion reaches", &R::replace);
    t.whole("milestones", "n", "configurations in the roadmap for motions around obstacles", 1, 100'000,
            &R::milestones);
    t.number("settle", "S", "seconds at rest before a pose is read (workspace: motion: settle, 0)", 0, 3600,
             &R::settle);
    t.number("reading", "S",
             "seconds of one reading; per target, where targets are read in turn (workspace: motion: reading, 0)", 0,
             3600, &R::reading);
    t.of_program("output,o", "FILE", "route as JSON (route.json; - for none)");
    t.of_program("poses-csv", "FILE", "poses in measuring order as CSV (none)");
    t.of_program("force", "", replaces);
    t.of_program("time-limit", "S", "stop after S seconds with the best order so far");
    t.row({"from", "FORMAT", "format of PLAN if it is not a plan: " + readable_format_names()});
  });
}

const OptionTable<ExportOptions>& export_options() {
  using E = ExportOptions;
  return table_filled_by<E>([](OptionTable<E>& t) {
    t.row({"to", "FORMAT", "format; list, or no --to: print the table of formats"});
    t.of_program("output,o", "FILE|DIR", "file or folder to write (a default name of the format; - for stdout)");
    t.of_program("force", "", replaces);
    t.text("name", "NAME", "name of the program (as the file), or of the robot in an SRDF", &E::name);
    t.row({"speed", "%", "speed in whole percent of full speed (10; joint-trajectory: of the route's speed)",
           OptionKind::whole},
          [](E& o, const GivenOption& given) { o.speed = whole_of(given, 1, 100); });
    t.number("settle", "S", "seconds at rest before a measurement (the route's, else 2)", 0, 3600, &E::settle);
    // Programs state hundredths of a second.
    t.number("wait", "S", "seconds for a measurement, instead of waiting for an input", 0.01, 3600, &E::wait);
    t.text("digital-output", "N", "output that triggers the instrument: number, or name for abb-rapid and staubli-val3",
           &E::digital_output, OptionKind::size);
    t.text("digital-input", "N", "input that reports the end of a measurement", &E::digital_input, OptionKind::size);
    t.text("tool", "N", "tool of the controller: number, or name of the tooldata for abb-rapid", &E::tool,
           OptionKind::size);
    t.text("payload", "N|KG,X,Y,Z", "load: payload schedule for fanuc-tp; kg and m of its centre for urscript",
           &E::payload, OptionKind::size);
    t.whole("base", "N", "base or user frame of the controller", 0, 255, &E::base);
    t.number("coupling", "F", "J3 of the controller is J3 - F*J2 of the plan; 0: no coupling", -10, 10, &E::coupling);
    t.row({"controller", "NAME",
           "known name, or YAML file: sign, zero_deg, range_deg, pulses_per_degree, coupling, axes, decimals, pivot_mm",
           OptionKind::file},
          [](E& o, const GivenOption& given) { o.controller = controller_settings(given.text()); });
    t.text("station", "NAME", "station whose targets a list of targets contains", &E::station);
    t.text("group", "NAME", "planning group of an SRDF (manipulator)", &E::group);
    t.row({"problem", "FILE", "problem file for the check of the program (the one named by the plan)"});
    t.row({"unchecked", "", "write the program without a check of limits and velocities", OptionKind::flag});
  });
}

const OptionTable<ReportOptions>& report_options() {
  using R = ReportOptions;
  return table_filled_by<R>([](OptionTable<R>& t) {
    t.of_program("output,o", "FILE", "the page (report.html; - for none)");
    t.text("route", "FILE", "route of the plan; the page shows its order and motions (none)", &R::route,
           OptionKind::file);
    t.of_program("problem", "FILE", "problem file (the one named by the plan)");
    t.row({"brief", "",
           "leave out the slow parts: gain of candidates, other numbers of poses that the plan does not state; of a "
           "problem: ways from home",
           OptionKind::flag},
          [](R& o, const GivenOption&) { o.sizes = o.candidates = false; });
    t.of_program("judge", "POSES", "plan: print whether each pose of this list is feasible; writes no page");
    t.of_program("watch", "", "result: rewrite the page whenever the file changes; the open page reloads");
    t.of_program("force", "", replaces);
    t.of_program("time-limit", "S", "stop after S seconds with the parts that are finished");
  });
}

std::vector<CommandRows> option_rows() {
  return {{"init", "init", rows_of(init_options())},
          {"observe", "observe", rows_of(observe_options())},
          {"plan", "plan", rows_of(plan_options())},
          {"select", "select", rows_of(select_options())},
          {"evaluate", "evaluate", rows_of(evaluate_options())},
          {"compare", "compare", rows_of(compare_options())},
          {"stations", "stations", rows_of(station_options())},
          {"simulate", "simulate", rows_of(simulate_options())},
          {"calibrate", "calibrate", rows_of(calibrate_options())},
          {"next", "next_poses", rows_of(next_options())},
          {"route", "route", rows_of(route_options())},
          {"export", "export", rows_of(export_options())},
          {"report", "report", rows_of(report_options())},
          {"compensate", "compensate", rows_of(compensate_options())}};
}

}  // namespace posewright
