#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arguments.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "design_keywords.hpp"
#include "made.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/model/variant.hpp"
#include "posewright/outputs/report.hpp"
#include "posewright/results/calibration.hpp"
#include "posewright/results/comparison.hpp"
#include "posewright/results/simulation.hpp"
#include "posewright/results/stations.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/report_problem.hpp"
#include "posewright/tasks/report_result.hpp"

namespace posewright::python {

using MadeCalibration = Made<Calibration, CalibrateOptions>;
using MadeComparison = Made<Comparison, CompareOptions>;
using MadeSimulation = Made<Simulation, SimulateOptions>;
using MadeStations = Made<std::vector<StationRank>, StationOptions>;

static std::string text_of(const MadeCalibration& m) { return calibration_text(m.value); }
static std::string text_of(const MadeComparison& m) { return comparison_text(m.value, !m.options.truth.empty()); }
static std::string text_of(const MadeSimulation& m) { return simulation_text(m.value, m.options); }
static std::string text_of(const MadeStations& m) { return stations_text(m.value); }
static auto json_of(const MadeCalibration& m) { return calibration_json(m.problem->problem, m.options, m.value); }
static auto json_of(const MadeComparison& m) { return comparison_json(m.problem->problem, m.options, m.value); }
static auto json_of(const MadeSimulation& m) { return simulation_json(m.problem->problem, m.options, m.value); }
static auto json_of(const MadeStations& m) { return stations_json(m.problem->problem, m.options, m.value); }

namespace {

Weighting weighting_named(const py::object& word) {
  return weighting_of(choice(word, "weights", {"ols", "wls", "robust"}));
}

MadeCalibration calibrate(const Shared& problem, const py::object& data, const std::string& variant,
                          const py::object& weights, bool prior, const std::string& moved, const py::object& validate,
                          long long hold_back, bool in_steps, bool interpolate, const py::object& profile,
                          py::object progress) {
  CalibrateOptions options;
  options.moved = moved_between(moved);
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

bool is_useful(const Calibration& c) { return c.verdict != Verdict::do_not_use; }

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

// Arguments that a function has beside the keys of the design.
const std::vector<std::string> of_compare{"variants", "truth"}, of_stations{};

MadeComparison compare(const Shared& problem, const py::dict& plans, const std::vector<std::string>& variants,
                       const std::string& truth, const py::int_& seed, long long threads, py::object progress,
                       const py::kwargs& design) {
  CompareOptions options;
  options.variants = variants;
  options.truth = truth;
  for (const char* name : {"poses", "method", "restarts"})
    if (!plans.empty() && design.contains(name) && !design[name].is_none())
      throw InputError({}, std::string(name) + " is for plans that are searched", "leave it out, or the plans");
  options.run = run_options(seed, threads);
  const auto compared = designed(*problem, design, of_compare, options.run);
  const std::vector<Coordinate> coordinates = coordinates_of(*compared, variants.empty() ? "" : variants.front());
  for (const auto& [name, list] : plans)
    options.plans.push_back(
        {py::cast<std::string>(name), pose_list(py::reinterpret_borrow<py::object>(list), coordinates)});
  return MadeComparison::of(compared, options, {}, std::move(progress), compare_problem);
}

MadeStations stations(const Shared& problem, const py::object& choose, long long full, const py::int_& seed,
                      long long threads, Limit time_limit, py::object progress, const py::kwargs& design) {
  StationOptions options;
  options.choose = optional_number(choose, "choose", 100);
  options.full = checked("full", full, 0, 10000);
  options.run = run_options(seed, threads);
  return MadeStations::of(designed(*problem, design, of_stations, options.run), options, time_limit,
                          std::move(progress), place_stations);
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
                             "{frame: 4 × 4} where the estimate puts base, tool, camera, board, stations")
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
  const py::none none;
  m.def("calibrate", &calibrate, py::arg("problem"), py::arg("data"), py::arg("variant") = "", py::kw_only(),
        py::arg("weights") = none, py::arg("prior") = true, py::arg("moved") = "auto", py::arg("validate") = none,
        py::arg("hold_back") = 0, py::arg("in_steps") = false, py::arg("interpolate") = false,
        py::arg("profile") = "auto", py::arg("progress") = none,
        R"(Estimates a variant's parameters from a file of measured data (docs/calibrate.md).

data: a file, or a list of files: campaigns; moved: what stands elsewhere in each further file: "base" (the instrument was moved), "tool" (all that the
tip carries), "both" or "nothing", "auto": the base, and the tool if the residuals ask for it; weights: "ols", "wls" (default) or "robust"; prior: tolerances of what was manufactured count; validate: a file of poses
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
  py::options signatures;
  signatures.disable_function_signatures();
  const std::string run = ", seed: int = 0, threads: int = 0";
  m.def("compare", &compare, py::arg("problem"), py::arg("plans") = py::dict(), py::kw_only(),
        py::arg("variants") = std::vector<std::string>(), py::arg("truth") = "", py::arg("seed") = 0,
        py::arg("threads") = 0, py::arg("progress") = none,
        (signature("compare", "problem: Problem, plans: dict = {}, *, variants: list[str] = [], truth: str = ''",
                   of_compare, run + ", progress: object = None", "Comparison") +
         "Variants against plans, {name: Plan, file or array}; without plans the best for each variant is searched. "
         "Other keywords are the keys of design, as in plan.")
            .c_str());
  m.def("stations", &stations, py::arg("problem"), py::kw_only(), py::arg("choose") = none, py::arg("full") = 3,
        py::arg("seed") = 0, py::arg("threads") = 0, py::arg("time_limit") = none, py::arg("progress") = none,
        (signature("stations", "problem: Problem, *, choose: Optional[int] = None, full: int = 3", of_stations,
                   run + ", time_limit: Optional[float] = None, progress: object = None", "Stations") +
         "Where the instrument should stand: ranks the places of workspace.stations. Other keywords are the keys of "
         "design, as in plan.")
            .c_str());
  signatures.enable_function_signatures();
  m.def("report", &report, py::arg("problem"), py::arg("plan"), py::kw_only(), py::arg("route") = none,
        py::arg("brief") = false, py::arg("threads") = 0, py::arg("time_limit") = none, py::arg("progress") = none,
        "The page of a plan.json, with its route.json; brief: without other numbers of poses, candidates and moved "
        "poses.");
}

}  // namespace posewright::python
