#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "keywords.hpp"
#include "made.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/problem/design_keys.hpp"
#include "posewright/report/report.hpp"
#include "posewright/report/report_problem.hpp"
#include "posewright/results/calibrated_dh_table.hpp"
#include "posewright/results/calibration.hpp"
#include "posewright/results/comparison.hpp"
#include "posewright/results/simulation.hpp"
#include "posewright/results/stations.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/compare_problem.hpp"
#include "posewright/tasks/place_stations.hpp"
#include "posewright/tasks/simulate_problem.hpp"

namespace posewright::python {

using MadeCalibration = Made<Calibration, CalibrateCall>;
using MadeComparison = Made<Comparison, CompareOptions>;
using MadeSimulation = Made<Simulation, SimulateOptions>;
using MadeStations = Made<std::vector<StationRank>, StationOptions>;

static std::optional<DhTable> table_of(const MadeCalibration& m) {
  return dh_table_of(m.problem->problem, m.value, m.options.dh);
}
static std::string text_of(const MadeCalibration& m) {
  const std::optional<DhTable> table = table_of(m);
  return calibration_text(m.value) + (table ? "\n" + dh_table_text(*table) : "");
}
static std::string text_of(const MadeComparison& m) { return comparison_text(m.value, !m.options.truth.empty()); }
static std::string text_of(const MadeSimulation& m) { return simulation_text(m.value, m.options); }
static std::string text_of(const MadeStations& m) { return stations_text(m.value); }
static auto json_of(const MadeCalibration& m) {
  return calibration_json(m.problem->problem, m.options, m.value, table_of(m));
}
static auto json_of(const MadeComparison& m) {
  return comparison_json(m.problem->problem, m.options.run.seed, m.value);
}
static auto json_of(const MadeSimulation& m) { return simulation_json(m.problem->problem, m.options, m.value); }
static auto json_of(const MadeStations& m) {
  return stations_json(m.problem->problem, m.options.run.seed, criterion_of_places(m.problem->problem), m.value);
}

namespace {

MadeCalibration calibrate(const Shared& problem, const py::object& data, const py::object& variant,
                          const py::kwargs& named) {
  Keywords keywords(named);
  keywords.set("variant", variant);
  CalibrateCall call;
  std::vector<std::filesystem::path> files;
  if (py::isinstance<py::list>(data) || py::isinstance<py::tuple>(data))
    files = data.cast<std::vector<std::filesystem::path>>();
  else files.push_back(data.cast<std::filesystem::path>());
  if (files.empty()) throw py::value_error("data: at least one file is expected");
  call.data = files.front();
  call.campaigns.assign(files.begin() + 1, files.end());
  keywords.read(calibrate_options(), call);
  if (call.models.size() > 1) throw InputError({}, "several variants are named", "calibrate one at a time");
  keywords.finish();
  return MadeCalibration::of(problem, call, {}, keywords.progress, calibrate_problem);
}

bool is_useful(const Calibration& c) { return c.verdict != Verdict::do_not_use; }

std::string parameters_text(const MadeCalibration& made) {
  const Problem& problem = made.problem->problem;
  return parameters_yaml({problem, find_variant(problem, made.value.variant)}, made.value.values,
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
  return dict_of(made.value.frames, &PlacedFrame::name,
                 [](const PlacedFrame& frame) { return array_of(Eigen::MatrixXd(frame.X.matrix())); });
}

MadeSimulation simulate(const Shared& problem, const py::object& poses, const py::object& variant,
                        const py::kwargs& named) {
  Keywords keywords(named);
  keywords.set("variant", variant);
  SimulateOptions options;
  keywords.read(simulate_options(), options);
  const Limit limit = keywords.time_limit();
  const PoseList list = pose_list(poses, coordinates_of(*problem, options.variant), keywords.text("from_"));
  keywords.finish();
  return MadeSimulation::of(problem, options, limit, keywords.progress,
                            [&](const Problem& p, const SimulateOptions& o, const Monitor& monitor) {
                              return simulate_problem(p, list, o, monitor);
                            });
}

// `variants` of the design would be taken for the compared ones.
const std::vector<std::string> of_compare{"variant", "truth", "variants"};

MadeComparison compare(const Shared& problem, const py::dict& plans, const py::kwargs& named) {
  Keywords keywords(named);
  CompareOptions options;
  keywords.read(compare_options(), options);
  for (const char* name : {"poses", "method", "restarts"})
    if (!plans.empty() && named.contains(name) && !named[name].is_none())
      throw InputError({}, std::string(name) + " is for plans that are searched", "leave it out, or the plans");
  const std::string format = keywords.text("from_");
  const auto compared = keywords.designed(*problem, of_compare, options.run);
  const std::vector<Coordinate> coordinates =
      coordinates_of(*compared, options.variants.empty() ? "" : options.variants.front());
  for (const auto& [name, list] : plans)
    options.plans.push_back(
        {py::cast<std::string>(name), pose_list(py::reinterpret_borrow<py::object>(list), coordinates, format)});
  return MadeComparison::of(compared, options, {}, keywords.progress, compare_problem);
}

MadeStations stations(const Shared& problem, const py::kwargs& named) {
  Keywords keywords(named);
  StationOptions options;
  keywords.read(station_options(), options);
  const Limit limit = keywords.time_limit();
  return MadeStations::of(keywords.designed(*problem, {}, options.run), options, limit, keywords.progress,
                          place_stations);
}

Report report(const Shared& problem, const std::filesystem::path& plan, const py::kwargs& named) {
  Keywords keywords(named);
  ReportOptions options;
  keywords.read(report_options(), options);
  const Limit limit = keywords.time_limit();
  keywords.finish();
  Problem planned = problem->problem;
  set_design(planned, edits_of_plan(plan));
  return watched(*problem, limit, keywords.progress, OnInterrupt::raise,
                 [&](const Monitor& monitor) { return report_problem(planned, plan, options, monitor); });
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
  const std::string run = ", seed: int = 0, threads: int = 0, progress: object = None";
  define(m, "calibrate", &calibrate,
         documentation("calibrate", "problem: Problem, data: object, variant: object = None, *",
                       rows_of(calibrate_options()), {"variant"}, false, ", threads: int = 0, progress: object = None",
                       "Calibration",
                       "Estimates a variant's parameters from a file of measured data, or a list of files, which are "
                       "campaigns of one robot (docs/calibrate.md)."),
         py::arg("problem"), py::arg("data"), py::arg("variant") = none);
  define(m, "simulate", &simulate,
         documentation("simulate", "problem: Problem, poses: object, variant: object = None, *",
                       rows_of(simulate_options()), {"variant"}, false, run_arguments, "Simulation",
                       "Measures the poses on robots with drawn parameters, calibrates, and compares with the truth "
                       "(docs/simulate.md). Lengths without unit in m, angles in rad."),
         py::arg("problem"), py::arg("poses"), py::arg("variant") = none);
  define(
      m, "compare", &compare,
      documentation("compare", "problem: Problem, plans: dict = {}, *", rows_of(compare_options()), {"variants"}, true,
                    run, "Comparison",
                    "Variants against plans, {name: Plan, file or array}; without plans the best for each variant is "
                    "searched. Other keywords are the keys of design, as in plan."),
      py::arg("problem"), py::arg("plans") = py::dict());
  define(
      m, "stations", &stations,
      documentation("stations", "problem: Problem, *", rows_of(station_options()), {}, true, run_arguments, "Stations",
                    "Ranks the places of workspace.stations for the instrument. Other keywords are the keys of design, "
                    "as in plan."),
      py::arg("problem"));
  define(m, "report", &report,
         documentation("report", "problem: Problem, plan: object, *", rows_of(report_options()), {}, false,
                       ", threads: int = 0, time_limit: Optional[float] = None, progress: object = None", "Report",
                       "The page of a plan.json, with its route.json."),
         py::arg("problem"), py::arg("plan"));
}

}  // namespace posewright::python
