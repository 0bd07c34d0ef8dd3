#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arguments.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/model/variant.hpp"
#include "posewright/outputs/report.hpp"
#include "posewright/results/calibration.hpp"
#include "posewright/results/comparison.hpp"
#include "posewright/results/compensation.hpp"
#include "posewright/results/next.hpp"
#include "posewright/results/simulation.hpp"
#include "posewright/results/stations.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/text_file.hpp"
#include "posewright/tasks/next_state.hpp"
#include "posewright/tasks/report_problem.hpp"
#include "posewright/tasks/report_result.hpp"

namespace posewright::python {
namespace {

using Limit = std::optional<double>;
using Shared = std::shared_ptr<GivenProblem>;

/// A result with what it was made from: its text and JSON are those of the command line.
template <class T, class Options>
struct Made {
  Shared problem;
  Options options;
  T value;

  /// Runs the work under a Watch; what it throws names keys of a problem that was not a file.
  template <class Work>
  static Made of(Shared problem, Options options, Limit time_limit, py::object progress, const Work& work) {
    Made made{std::move(problem), std::move(options), {}};
    Watch watch(time_limit, std::move(progress));
    watch.run(
        [&](const Monitor& monitor) {
          made.value = with_places(*made.problem, [&] { return work(made.problem->problem, made.options, monitor); });
        },
        OnInterrupt::raise);
    return made;
  }
};

using MadeCalibration = Made<Calibration, CalibrateOptions>;
using MadeCompensation = Made<Compensation, CompensateOptions>;
using MadeComparison = Made<Comparison, CompareOptions>;
using MadeSimulation = Made<Simulation, SimulateOptions>;
/// Next poses with what was said before them.
struct NextStep {
  NextPoses next;
  std::vector<NextPoint> history;
};
using MadeNext = Made<NextStep, NextOptions>;
using MadeStations = Made<std::vector<StationRank>, StationOptions>;

std::string text_of(const MadeCalibration& m) { return calibration_text(m.value); }
std::string text_of(const MadeComparison& m) { return comparison_text(m.value, !m.options.truth.empty()); }
std::string text_of(const MadeCompensation& m) { return compensation_text(m.value); }
std::string text_of(const MadeNext& m) { return next_text(m.value.next); }
std::string text_of(const MadeSimulation& m) { return simulation_text(m.value, m.options); }
std::string text_of(const MadeStations& m) { return stations_text(m.value); }
auto json_of(const MadeCalibration& m) { return calibration_json(m.problem->problem, m.options, m.value); }
auto json_of(const MadeComparison& m) { return comparison_json(m.problem->problem, m.options, m.value); }
auto json_of(const MadeCompensation& m) { return compensation_json(m.problem->problem, m.value); }
auto json_of(const MadeNext& m) { return next_json(m.problem->problem, m.options, m.value.next, m.value.history); }
auto json_of(const MadeSimulation& m) { return simulation_json(m.problem->problem, m.options, m.value); }
auto json_of(const MadeStations& m) { return stations_json(m.problem->problem, m.options, m.value); }

/// What all results have.
template <class M>
py::class_<M> bind_made(py::module_& m, const char* name, const char* doc) {
  return py::class_<M>(m, name, doc)
      .def(
          "summary", [](const M& made) { return text_of(made); }, "The table that the command line prints.")
      .def(
          "to_json", [](const M& made) { return json_text(json_of(made)); }, "What the command prints with --json.")
      .def("to_dict", [](const M& made) { return parsed(json_text(json_of(made), JsonLayout::one_line)); });
}

/// Of results with a page of their own.
template <class M>
py::class_<M> bind_page(py::class_<M> made) {
  return made.def(
      "to_html",
      [](const M& m) {
        return report_html(ResultReport{.title = title_of(m.problem->problem.file),
                                        .file = {},
                                        .result_json = json_text(json_of(m), JsonLayout::one_line)});
      },
      "The page that posewright report makes of it.");
}

Weighting weighting_named(const py::object& word) {
  return weighting_of(choice(word, "weights", {"ols", "wls", "robust"}));
}

MadeCalibration calibrate(const Shared& problem, const py::object& data, const std::string& variant,
                          const py::object& weights, bool prior, const py::object& validate, long long hold_back,
                          bool in_steps, bool interpolate, const py::object& profile, py::object progress) {
  CalibrateOptions options;
  std::vector<std::filesystem::path> files;
  if (py::isinstance<py::list>(data) || py::isinstance<py::tuple>(data))
    files = data.cast<std::vector<std::filesystem::path>>();
  else files.push_back(data.cast<std::filesystem::path>());
  if (files.empty()) throw py::value_error("data: at least one file is expected");
  options.data = files.front();
  options.campaigns.assign(files.begin() + 1, files.end());
  options.variant = variant;
  options.weighting = weighting_named(weights);
  options.prior = prior ? Prior::manufactured : Prior::none;
  if (!validate.is_none()) options.validate = validate.cast<std::filesystem::path>();
  options.hold_back = hold_back == 0 ? 0 : checked("hold_back", hold_back, 2, most_poses);
  options.in_steps = in_steps;
  options.interpolate = interpolate;
  if (py::isinstance<py::str>(profile)) options.profile = profile_choice(profile.cast<std::string>());
  else options.profile = {ProfileChoice::named, profile.cast<std::vector<std::string>>()};
  if (options.profile.choice == ProfileChoice::named && options.weighting == Weighting::robust)
    throw py::value_error("profile: weights \"ols\" or \"wls\" are expected");
  return MadeCalibration::of(problem, options, {}, std::move(progress), calibrate_problem);
}

bool is_useful(const Calibration& c) { return c.fit.converged && !c.left_out.refused(); }

std::string parameters_text(const MadeCalibration& made) {
  const Problem& problem = made.problem->problem;
  return parameters_yaml(problem, find_variant(problem, made.value.variant), made.value.values,
                         shown_effect(made.value));
}

void save_parameters(const MadeCalibration& made, const py::object& path, bool overwrite, bool force) {
  if (!made.value.fit.converged || (!is_useful(made.value) && !force))
    throw CannotDo("nothing is written: these parameters are not good enough to use");
  save_text(path, parameters_text(made), overwrite);
}

template <class Value>
py::dict estimated(const Calibration& c, Value value) {
  py::dict result;
  for (const CalibratedParameter& p : c.parameters)
    if (p.estimated) result[py::str(p.label.name)] = value(p);
  return result;
}

py::dict frames_of(const MadeCalibration& made) {
  py::dict result;
  for (const PlacedFrame& frame : made.value.frames)
    result[py::str(frame.name)] = array_of(Eigen::MatrixXd(frame.X.matrix()));
  return result;
}

MadeSimulation simulate(const Shared& problem, const py::object& poses, const std::string& variant,
                        const std::string& truth, long long draws, bool exact, double missing, double outliers,
                        const py::object& weights, bool prior, bool profile, long long validation,
                        const std::string& format, const py::int_& seed, long long threads, Limit time_limit,
                        py::object progress) {
  SimulateOptions options;
  options.variant = variant;
  options.truth = truth;
  ExperimentOptions& experiment = options.experiment;
  experiment.draws = checked("draws", draws, 2, 10'000'000);
  experiment.exact = exact;
  if (!(missing >= 0 && missing <= 0.9)) throw InputError({}, "missing is a share", "0 to 0.9 is allowed");
  if (!(outliers >= 0 && outliers <= 1)) throw InputError({}, "outliers is a share", "0 to 1 is allowed");
  experiment.missing = missing;
  experiment.outliers = outliers;
  experiment.fit.weighting = weighting_named(weights);
  experiment.fit.prior = prior ? Prior::manufactured : Prior::none;
  experiment.profile = profile;
  options.validation = checked("validation", validation, 1, most_poses);
  experiment.seed = seed_of(seed);
  experiment.threads = checked("threads", threads, 0, most_threads);
  const PoseList list = pose_list(poses, coordinates_of(*problem, variant), format);
  return MadeSimulation::of(problem, options, time_limit, std::move(progress),
                            [&](const Problem& p, const SimulateOptions& o, const Monitor& monitor) {
                              return simulate_problem(p, list, o, monitor);
                            });
}

MadeComparison compare(const Shared& problem, const py::dict& plans, const std::vector<std::string>& variants,
                       const std::string& truth, const py::object& poses, const std::string& method,
                       const py::object& candidates, const py::object& restarts, const py::int_& seed,
                       long long threads, py::object progress) {
  CompareOptions options;
  options.variants = variants;
  options.truth = truth;
  if (!plans.empty() && (!poses.is_none() || !method.empty() || !restarts.is_none()))
    throw InputError({}, "poses, method and restarts are for plans that are searched", "leave them out, or the plans");
  const std::vector<Coordinate> coordinates = coordinates_of(*problem, variants.empty() ? "" : variants.front());
  for (const auto& [name, list] : plans)
    options.plans.push_back(
        {py::cast<std::string>(name), pose_list(py::reinterpret_borrow<py::object>(list), coordinates)});
  options.plan.poses = optional_number(poses, "poses", most_poses);
  options.plan.method = method;
  set_search(options.plan, candidates, restarts, seed, threads);
  return MadeComparison::of(problem, options, {}, std::move(progress), compare_problem);
}

MadeCompensation compensate(const Shared& problem, const py::object& poses, bool base, bool tool, bool position_only,
                            bool elastic_target, double most, const std::string& format, long long threads,
                            py::object progress) {
  if (!problem->problem.parameters)
    throw InputError({}, "problem has no calibrated parameters", "Problem(..., parameters=FILE)");
  CompensateOptions options;
  options.solver.with_base = base;
  options.solver.with_tool = tool;
  options.solver.position_only = position_only;
  options.elastic_target = elastic_target;
  if (!(most > 0 && most <= 3.15)) throw InputError({}, "most is a largest turn in rad", "above 0, at most 3.15");
  // A joint that slides may move a millimetre where one that turns may turn by a tenth of a degree.
  options.solver.most_length = options.solver.most_length * most / options.solver.most_angle;
  options.solver.most_angle = most;
  options.threads = checked("threads", threads, 0, most_threads);
  const PoseList list =
      pose_list(poses, with_places(*problem, [&] { return compensation_coordinates(problem->problem); }), format);
  return MadeCompensation::of(problem, options, {}, std::move(progress),
                              [&](const Problem& p, const CompensateOptions& o, const Monitor& monitor) {
                                return compensate_problem(p, {list}, o, monitor);
                              });
}

/// One row a pose.
template <class Row>
py::array_t<double> pose_rows(const Compensation& c, std::size_t columns, Row row) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < c.lists.front().solutions.size(); ++i) rows.push_back(row(c.lists.front(), i));
  return array_of(rows, columns);
}

py::array_t<double> commanded_configurations(const MadeCompensation& made) {
  return pose_rows(made.value, made.value.coordinates.size(), [](const CompensatedList& list, std::size_t i) {
    const auto q = list.configuration(i);
    return std::vector<double>(q.begin(), q.end());
  });
}

py::object commanded_actuators(const MadeCompensation& made) {
  if (!made.value.parallel) return py::none();
  const std::size_t width = made.value.axes.size();
  return pose_rows(made.value, width, [&](const CompensatedList& list, std::size_t i) {
    const auto first = list.actuators.begin() + std::ptrdiff_t(i * width);
    return std::vector<double>(first, first + std::ptrdiff_t(width));
  });
}

void bind_compensation(py::module_& m) {
  using C = MadeCompensation;
  const auto errors = [](TipError CommandSolver::Solution::*which) {
    return [which](const C& c) {
      return pose_rows(c.value, 2, [&](const CompensatedList& list, std::size_t i) {
        const TipError& e = list.solutions[i].*which;
        return std::vector<double>{e.position, e.rotation};
      });
    };
  };
  bind_made<C>(m, "Compensation",
               "What to command so that the calibrated robot is where it was meant to; docs/compensate.md.")
      .def_property_readonly("configurations", &commanded_configurations,
                             "N × coordinates, SI; as listed where a pose is not compensated")
      .def_property_readonly("actuators", &commanded_actuators, "N × actuators of a parallel robot, else None")
      .def_property_readonly(
          "compensated",
          [](const C& c) {
            std::vector<bool> reached;
            for (const auto& s : c.value.lists.front().solutions)
              reached.push_back(s.outcome == CommandSolver::Outcome::reached);
            return reached;
          },
          "of each pose")
      .def_property_readonly("before", errors(&CommandSolver::Solution::before),
                             "N × 2: predicted error of the tip (m, rad), commanded as listed")
      .def_property_readonly("after", errors(&CommandSolver::Solution::after), "N × 2: the same, commanded so")
      .def_property_readonly(
          "failures",
          [](const C& c) {
            std::vector<std::string> texts;
            for (const NotCompensated& n : c.value.failures) texts.push_back(n.text());
            return texts;
          },
          "poses that cannot be commanded, and why")
      .def_property_readonly("notes", [](const C& c) { return c.value.notes; })
      .def("__repr__", [](const C& c) {
        return py::str("<Compensation of {} poses, {} not compensated>")
            .format(c.value.lists.front().solutions.size(), c.value.failures.size());
      });
}

constexpr std::uintmax_t largest_data = 1'000'000'000;

/// The file's whole lines; a file that is not there yet has none.
WholeLines lines_of(const std::filesystem::path& file) {
  std::error_code code;
  if (file.empty() || !std::filesystem::exists(file, code)) return {};
  return whole_lines(read_text(file, largest_data));
}

NextStep step_of(const Problem& problem, NextOptions& options, const std::filesystem::path& state_file,
                 const Monitor& monitor) {
  const WholeLines lines = lines_of(options.data);
  std::optional<NextState> state;
  if (!state_file.empty()) state = read_next_state(state_file);
  if (state) require_continues(*state, state_file, problem, options.data, lines.text);
  if (lines.has_rows) options.text = lines.text;
  if (state) reuse(*state, problem, options);
  NextStep step{next_poses(problem, options, monitor), {}};
  const NextState now = state_after(problem, options, step.next, state);
  step.history = now.history;
  if (!state_file.empty()) write_file_atomically(state_file, next_state_text(now));
  return step;
}

MadeNext next_poses_of(const Shared& problem, const py::object& data, long long poses, const py::object& required,
                       const std::string& variant, const std::string& criterion, bool prior,
                       const py::object& candidates, const py::object& candidates_from, const py::object& state,
                       const py::int_& seed, long long threads, Limit time_limit, py::object progress) {
  NextOptions options;
  if (!data.is_none()) options.data = data.cast<std::filesystem::path>();
  options.poses = checked("poses", poses, 1, 1000);
  options.required = within(required, "required", 1e-12, 1e3);
  options.variant = variant;
  options.criterion = criterion;
  options.prior = prior ? Prior::manufactured : Prior::none;
  options.candidates = optional_number(candidates, "candidates", 10'000'000);
  if (!candidates_from.is_none())
    options.candidates_from = pose_list(candidates_from, without_limits(coordinates_of(*problem, variant)));
  options.seed = seed_of(seed);
  options.threads = checked("threads", threads, 0, most_threads);
  const auto state_file = state.is_none() ? std::filesystem::path() : state.cast<std::filesystem::path>();
  MadeNext made{problem, std::move(options), {}};
  Watch watch(time_limit, std::move(progress));
  watch.run(
      [&](const Monitor& monitor) {
        made.value = with_places(*made.problem,
                                 [&] { return step_of(made.problem->problem, made.options, state_file, monitor); });
      },
      OnInterrupt::raise);
  return made;
}

py::array_t<double> next_configurations(const MadeNext& made) {
  std::vector<std::vector<double>> rows;
  std::size_t width = 0;
  for (const PlannedPose& pose : made.value.next.poses) {
    rows.emplace_back();
    for (const NamedValue& v : pose.configuration) rows.back().push_back(v.value);
    width = rows.back().size();
  }
  return array_of(rows, width);
}

void bind_next(py::module_& m) {
  using N = MadeNext;
  const auto now = [](std::optional<double> NextPoint::*which) {
    return [which](const N& n) -> std::optional<double> {
      const std::vector<NextPoint>& curve = n.value.next.curve;
      return curve.empty() ? std::nullopt : curve.back().*which;
    };
  };
  bind_made<N>(m, "NextPoses", "Which poses to measure next, and whether to go on; docs/next.md.")
      .def_property_readonly("configurations", &next_configurations, "N × n, SI, without load cases and stations")
      .def_property_readonly("poses", [](const N& n) { return n.value.next.poses; })
      .def_property_readonly(
          "stop",
          [](const N& n) {
            return n.value.next.verdict == NextVerdict::reached || n.value.next.verdict == NextVerdict::flat;
          },
          "the required accuracy is reached, or the curve is flat")
      .def_property_readonly(
          "verdict", [](const N& n) { return verdict_name(n.value.next.verdict); },
          "not_determined, go_on, reached or flat")
      .def_property_readonly(
          "reason", [](const N& n) { return next_reason(n.value.next); }, "the same in words and figures")
      .def_property_readonly("error", now(&NextPoint::expected),
                             "predicted at the test poses, m; None: not all parameters are told yet")
      .def_property_readonly("upper", now(&NextPoint::upper), "what it is below with 95 % confidence, m")
      .def_property_readonly(
          "estimates",
          [](const N& n) {
            py::dict values;
            for (const EstimatedValue& e : n.value.next.estimates) values[py::str(e.value.name)] = e.value.value;
            return values;
          },
          "{parameter: value} of the fit so far, SI")
      .def_property_readonly("notes", [](const N& n) { return n.value.next.notes; })
      .def("__len__", [](const N& n) { return n.value.next.poses.size(); })
      .def("__repr__", [](const N& n) {
        return py::str("<NextPoses after {}: {}>").format(n.value.next.measured, verdict_name(n.value.next.verdict));
      });
}

MadeStations stations(const Shared& problem, const py::object& choose, long long full, const py::object& poses,
                      const std::string& variant, const std::string& criterion, const py::object& candidates,
                      const py::object& restarts, const py::int_& seed, long long threads, Limit time_limit,
                      py::object progress) {
  StationOptions options;
  options.choose = optional_number(choose, "choose", 100);
  options.full = checked("full", full, 0, 10000);
  options.plan.poses = optional_number(poses, "poses", most_poses);
  options.plan.variant = variant;
  options.plan.criterion = criterion;
  set_search(options.plan, candidates, restarts, seed, threads);
  return MadeStations::of(problem, options, time_limit, std::move(progress), place_stations);
}

Report report(const Shared& problem, const std::filesystem::path& plan, const py::object& route, bool brief,
              long long threads, Limit time_limit, py::object progress) {
  ReportOptions options;
  if (!route.is_none()) options.route = route.cast<std::filesystem::path>();
  options.sizes = options.candidates = options.moves = !brief;
  options.threads = checked("threads", threads, 0, most_threads);
  Report result;
  Watch watch(time_limit, std::move(progress));
  watch.run(
      [&](const Monitor& monitor) {
        result = with_places(*problem, [&] { return report_problem(problem->problem, plan, options, monitor); });
      },
      OnInterrupt::raise);
  return result;
}

void bind_classes(py::module_& m) {
  using C = MadeCalibration;
  bind_page(bind_made<C>(m, "Calibration", "Parameters estimated from measured data; docs/calibrate.md."))
      .def_property_readonly("variant", [](const C& c) { return c.value.variant; })
      .def_property_readonly("converged", [](const C& c) { return c.value.fit.converged; })
      .def_property_readonly(
          "useful", [](const C& c) { return is_useful(c.value); },
          "converged, and poses left out are predicted better than without the parameters")
      .def_property_readonly(
          "values", [](const C& c) { return estimated(c.value, [](const auto& p) { return p.value; }); },
          "{parameter: value} of what was estimated, SI")
      .def_property_readonly(
          "sigma", [](const C& c) { return estimated(c.value, [](const auto& p) { return p.sigma; }); }, "1σ of them")
      .def_property_readonly(
          "columns", [](const C& c) { return c.value.columns; }, "of the covariance")
      .def_property_readonly("covariance", [](const C& c) { return array_of(Eigen::MatrixXd(c.value.fit.covariance)); })
      .def_property_readonly("frames", &frames_of,
                             "{frame: 4 × 4} where the estimate puts base, camera, board, stations")
      .def_property_readonly(
          "noise_factor", [](const C& c) { return c.value.fit.noise_factor; }, "noise found over noise stated")
      .def_property_readonly("notes", [](const C& c) { return c.value.notes; })
      .def("parameters_file", &parameters_text, "Text of a parameters file, for Problem(..., parameters=) and others.")
      .def("save", &save_parameters, py::arg("path"), py::kw_only(), py::arg("overwrite") = false,
           py::arg("force") = false, "Writes the parameters file; CannotDo unless useful, or converged with force.")
      .def("__repr__", [](const C& c) {
        return py::str("<Calibration of {}: {} poses, {} parameters>")
            .format(c.value.variant, c.value.poses, c.value.columns.size());
      });
  using S = MadeSimulation;
  bind_page(bind_made<S>(m, "Simulation",
                         "Virtual calibrations with the poses, against what the plan predicts; docs/simulate.md."))
      .def_property_readonly(
          "confirmed", [](const S& s) { return s.value.confirmed; }, "σ and intervals as predicted")
      .def_property_readonly("verdict", [](const S& s) { return s.value.verdict; })
      .def_property_readonly(
          "first_readings", [](const S& s) { return s.value.first_readings; },
          "of the first draw, as calibrate reads them")
      .def_property_readonly("notes", [](const S& s) { return s.value.notes; });
  using M = MadeComparison;
  bind_page(bind_made<M>(m, "Comparison", "Variants against plans; docs/compare.md."))
      .def_property_readonly("notes", [](const M& c) { return c.value.notes; });
  bind_page(bind_made<MadeStations>(m, "Stations", "Places for the instrument, best first."))
      .def("__len__", [](const MadeStations& s) { return s.value.size(); });
  py::class_<Report>(m, "Report", "A page to look at; docs/report.md.")
      .def("to_html", [](const Report& r) { return report_html(r); })
      .def(
          "to_json", [](const Report& r) { return report_json(r); }, "The numbers behind the page.")
      .def("to_dict", [](const Report& r) { return parsed(report_json(r)); })
      .def_readonly("notes", &Report::notes)
      .def(
          "save",
          [](const Report& r, const py::object& path, bool overwrite) { save_text(path, report_html(r), overwrite); },
          py::arg("path"), py::kw_only(), py::arg("overwrite") = false, "Writes the page.");
}

}  // namespace

void bind_tasks(py::module_& m) {
  bind_classes(m);
  bind_compensation(m);
  bind_next(m);
  const py::none none;
  m.def("calibrate", &calibrate, py::arg("problem"), py::arg("data"), py::arg("variant") = "", py::kw_only(),
        py::arg("weights") = none, py::arg("prior") = true, py::arg("validate") = none, py::arg("hold_back") = 0,
        py::arg("in_steps") = false, py::arg("interpolate") = false, py::arg("profile") = "auto",
        py::arg("progress") = none,
        R"(Estimates a variant's parameters from a file of measured data (docs/calibrate.md).

data: a file, or a list of files: campaigns, each with a base of its own; weights: "ols", "wls" (default) or "robust"; prior: tolerances of what was manufactured count; validate: a file of poses
that are not fitted; hold_back: every so many-th pose is not fitted; in_steps: also base and tool, geometry, stiffness
one after the other; interpolate: predict with what the parameters leave as well (a variant with `unmodelled`); profile: parameters
whose intervals are by profile likelihood: "auto" (those that the curvature names), "none", "all", or names and globs.)");
  m.def("simulate", &simulate, py::arg("problem"), py::arg("poses"), py::arg("variant") = "", py::kw_only(),
        py::arg("truth") = "", py::arg("draws") = 1000, py::arg("exact") = false, py::arg("missing") = 0.0,
        py::arg("outliers") = 0.0, py::arg("weights") = none, py::arg("prior") = true, py::arg("profile") = false,
        py::arg("validation") = 50, py::arg("format") = "", py::arg("seed") = 0, py::arg("threads") = 0,
        py::arg("time_limit") = none, py::arg("progress") = none,
        "Measures the poses on robots with drawn parameters, calibrates, and compares with the truth "
        "(docs/simulate.md).");
  m.def("compensate", &compensate, py::arg("problem"), py::arg("poses"), py::kw_only(), py::arg("base") = false,
        py::arg("tool") = true, py::arg("position_only") = false, py::arg("elastic_target") = false,
        py::arg("most") = CommandSolver::Options{}.most_angle, py::arg("format") = "", py::arg("threads") = 0,
        py::arg("progress") = none,
        R"(Commands for the calibrated robot, so that it stands where the nominal one was meant to (docs/compensate.md).

problem: with parameters; base, tool: what was found of them counts; position_only: orientations may be what they will;
elastic_target: the poses were found with the nominal springs; most: largest turn that is a correction, rad.)");
  m.def("compare", &compare, py::arg("problem"), py::arg("plans") = py::dict(), py::kw_only(),
        py::arg("variants") = std::vector<std::string>(), py::arg("truth") = "", py::arg("poses") = none,
        py::arg("method") = "", py::arg("candidates") = none, py::arg("restarts") = none, py::arg("seed") = 0,
        py::arg("threads") = 0, py::arg("progress") = none,
        "Variants against plans, {name: Plan, file or array}; without plans the best for each variant is searched.");
  m.def("stations", &stations, py::arg("problem"), py::kw_only(), py::arg("choose") = none, py::arg("full") = 3,
        py::arg("poses") = none, py::arg("variant") = "", py::arg("criterion") = "", py::arg("candidates") = none,
        py::arg("restarts") = none, py::arg("seed") = 0, py::arg("threads") = 0, py::arg("time_limit") = none,
        py::arg("progress") = none, "Where the instrument should stand: ranks the places of workspace.stations.");
  m.def("next_poses", &next_poses_of, py::arg("problem"), py::arg("data") = none, py::arg("poses") = 1, py::kw_only(),
        py::arg("required") = none, py::arg("variant") = "", py::arg("criterion") = "", py::arg("prior") = true,
        py::arg("candidates") = none, py::arg("candidates_from") = none, py::arg("state") = none, py::arg("seed") = 0,
        py::arg("threads") = 0, py::arg("time_limit") = none, py::arg("progress") = none,
        R"(Fits what is measured so far, chooses the next poses, says when to stop (docs/next.md).

data: the file of readings, whole lines count; None or no such file: nothing is measured; required: error at the test
poses that suffices, m (None: the problem's); prior: tolerances of what was manufactured count; state: a file that is
read and written anew, so that candidates are drawn once and other data are noticed.)");
  m.def("report", &report, py::arg("problem"), py::arg("plan"), py::kw_only(), py::arg("route") = none,
        py::arg("brief") = false, py::arg("threads") = 0, py::arg("time_limit") = none, py::arg("progress") = none,
        "The page of a plan.json, with its route.json; brief: without other numbers of poses, candidates and moved "
        "poses.");
}

}  // namespace posewright::python
