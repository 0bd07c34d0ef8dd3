#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "posewright/results/evaluation.hpp"
#include "posewright/results/observation.hpp"
#include "posewright/results/route.hpp"
#include "posewright/support/json.hpp"

namespace posewright::python {
namespace {

/// A dependency together with the names of its parameters.
struct NamedDependency {
  Dependency dependency;
  std::vector<Parameter> parameters;
};

std::vector<NamedDependency> named(const std::vector<Dependency>& found, const std::vector<Parameter>& parameters) {
  return of_each(found, [&](const Dependency& d) { return NamedDependency{d, parameters}; });
}

void bind_dependency(py::module_& m) {
  using D = NamedDependency;
  py::class_<D>(m, "Dependency", "A parameter that looks like a combination of others.")
      .def_property_readonly("dropped", [](const D& d) { return d.parameters[std::size_t(d.dependency.dropped)].name; })
      .def_property_readonly(
          "terms",
          [](const D& d) {
            py::dict terms;
            for (const Dependency::Term& t : d.dependency.terms)
              terms[py::str(d.parameters[std::size_t(t.parameter)].name)] = t.coefficient;
            return terms;
          },
          "{parameter: coefficient}, SI; empty: no effect at all")
      .def_property_readonly(
          "remainder", [](const D& d) { return d.dependency.remainder; }, "share of its effect that they leave over")
      .def_property_readonly("equation", [](const D& d) { return describe(d.dependency, d.parameters); })
      .def("__repr__", [](const D& d) { return "<Dependency " + describe(d.dependency, d.parameters) + ">"; });
}

}  // namespace

void bind_evaluation(py::module_& m) {
  using E = PoseListEvaluation;
  py::class_<CriterionScore>(m, "Score", "One criterion of a list of poses.")
      .def_readonly("name", &CriterionScore::name)
      .def_readonly("value", &CriterionScore::value, "in its own terms")
      .def_readonly("efficiency", &CriterionScore::efficiency,
                    "lower bound of the share of the best of as many candidates; None: no bound")
      .def("__repr__", [](const CriterionScore& s) { return py::str("<Score {}: {:.6g}>").format(s.name, s.value); });
  py::class_<ListChange>(m, "Change", "A change of a list and what it brings.")
      .def_readonly("poses", &ListChange::poses, "ids to drop, 1 = the first of the list")
      .def_readonly("added", &ListChange::added, "poses to add")
      .def_property_readonly("configurations", [](const ListChange& c) { return pose_configurations(c.added); })
      .def_readonly("efficiency", &ListChange::efficiency, "of the changed list relative to the list as it is")
      .def_readonly("log_det", &ListChange::log_det)
      .def_readonly("rho0", &ListChange::rho0, "m, or None")
      .def("__repr__", [](const ListChange& c) {
        return py::str("<Change: {} poses, {:.2f} % of the list>")
            .format(c.poses.size() + c.added.size(), 100 * c.efficiency);
      });
  py::class_<E>(m, "Evaluation", "What a list of poses is worth.")
      .def_readonly("plan", &E::plan, "the list as a plan: log det, sigma, contributions, certificate")
      .def_property_readonly(
          "scores", [](const E& e) { return dict_of(e.scores, &CriterionScore::name, std::identity()); },
          "{criterion: Score}")
      .def_readonly("drop", &E::drop, "which poses to leave out, or None")
      .def_readonly("add", &E::add, "which poses to measure more, or None")
      .def("summary", &evaluation_text, "The table that the command line prints.")
      .def("to_json", [](const E& e) { return json_text(evaluation_json(e)); })
      .def("to_dict", [](const E& e) { return parsed(json_text(evaluation_json(e), JsonLayout::one_line)); })
      .def("__repr__", [](const E& e) { return "<Evaluation: " + plan_line(e.plan) + ">"; });
}

void bind_observation(py::module_& m) {
  bind_dependency(m);
  using O = Observation;
  py::class_<O>(m, "Observation", "Which parameters of one variant a pool of configurations can identify.")
      .def_readonly("variant", &O::variant)
      .def_readonly("configurations", &O::configurations, "number of drawn configurations")
      .def_readonly("rows", &O::rows, "readings of one configuration")
      .def_property_readonly("rank", [](const O& o) { return o.identifiability.rank; })
      .def_readonly("exact_rank", &O::exact_rank, "where only dependencies to rounding count")
      .def_property_readonly(
          "singular_values", [](const O& o) { return array_of(o.identifiability.singular_values); },
          "of G with columns in units of tolerance, descending")
      .def_property_readonly(
          "parameters", [](const O& o) { return of_each(o.parameters, unplanned); }, "all free ones, nuisance first")
      .def_property_readonly(
          "kept", [](const O& o) { return of_each(o.kept, &Parameter::name); }, "names of the independent ones")
      .def_property_readonly("dependencies",
                             [](const O& o) { return named(o.identifiability.dependencies, o.parameters); })
      .def_property_readonly(
          "indices", [](const O& o) { return indices_dict(o.indices); }, "of the whole pool")
      .def_readonly("smallest_poses", &O::smallest_poses,
                    "that determine all kept ones; None: the pool does not suffice")
      .def_property_readonly(
          "recommended",
          [](const O& o) -> std::optional<std::vector<std::string>> {
            if (!o.practical) return std::nullopt;
            return of_each(o.practical->recommended, [&](int j) { return o.kept[std::size_t(j)].name; });
          },
          "what is worth identifying, nuisance included; None where nothing can be said")
      .def_property_readonly(
          "sigma",
          [](const O& o) -> py::object { return o.practical ? array_of(o.practical->sigma) : py::object(py::none()); },
          "predicted 1σ of the kept ones, SI")
      .def_property_readonly(
          "near_dependencies",
          [](const O& o) { return o.practical ? named(o.practical->near, o.kept) : std::vector<NamedDependency>(); },
          "of kept ones that mostly look like others")
      .def(
          "summary", [](const Observation& o) { return observation_text(o); },
          "The table that the command line prints.")
      .def("to_dict", [](const O& o) { return parsed(json_text(observation_json(o), JsonLayout::one_line)); })
      .def("__repr__", [](const O& o) {
        return py::str("<Observation of {}: rank {} of {} parameters>")
            .format(o.variant, o.identifiability.rank, o.parameters.size());
      });
}

void bind_route(py::module_& m) {
  py::class_<RouteMotion>(m, "Motion", "From one stop to the next, straight from point to point.")
      .def_readonly("start", &RouteMotion::from, "pose id; 0: home")
      .def_readonly("end", &RouteMotion::to, "pose id; 0: home")
      .def_property_readonly(
          "points",
          [](const RouteMotion& r) { return array_of(r.points, r.points.empty() ? 0 : r.points.front().size()); },
          "both ends and the via points, k × n")
      .def_readonly("seconds", &RouteMotion::seconds)
      .def_readonly("change_seconds", &RouteMotion::change_seconds)
      .def_readonly("found_by", &RouteMotion::found_by)
      .def("__repr__", [](const RouteMotion& r) {
        return py::str("<Motion {} to {}: {:.2f} s, {}>").format(r.from, r.to, r.seconds, r.found_by);
      });
  py::class_<Route>(m, "Route", "Order of measurement and the motions between the poses; docs/cell.md.")
      .def_property_readonly(
          "order", [](const Route& r) { return of_each(r.poses, &PlannedPose::id); }, "pose ids")
      .def_readonly("poses", &Route::poses, "in measuring order")
      .def_property_readonly(
          "configurations", [](const Route& r) { return pose_configurations(r.poses); }, "in that order")
      .def_readonly("motions", &Route::motions)
      .def_readonly("names", &Route::names, "of what moves")
      .def_readonly("units", &Route::units)
      .def_property_readonly("home", [](const Route& r) { return array_of(r.home); })
      .def_property_readonly(
          "unreachable",
          [](const Route& r) { return dict_of(r.unreachable, &SkippedPose::pose, &SkippedPose::reason); },
          "{pose id: reason}")
      .def_property_readonly("travel_seconds", &Route::travel_seconds)
      .def_property_readonly("change_seconds", &Route::change_seconds)
      .def_readonly("planned_seconds", &Route::planned_seconds, "of the list's own order at least")
      .def_readonly("optimal", &Route::optimal, "no order of these motions is shorter")
      .def_readonly("problem_changed", &Route::problem_changed)
      .def("summary", &route_summary, "The table that the command line prints.")
      .def(
          "to_json", [](const Route& r) { return route_json(r); }, "route.json.")
      .def("to_dict", [](const Route& r) { return parsed(route_json(r)); })
      .def("to_csv", &route_csv, "Poses in measuring order, as poses.csv.")
      .def(
          "save",
          [](const Route& r, const py::object& path, bool overwrite) {
            const bool csv = path.cast<std::filesystem::path>().extension() == ".csv";
            save_text(path, csv ? route_csv(r) : route_json(r), overwrite);
          },
          py::arg("path"), py::kw_only(), py::arg("overwrite") = false,
          "Writes route.json, or poses.csv in measuring order where the name ends in .csv.")
      .def("__repr__", [](const Route& r) {
        return py::str("<Route: {} poses, {:.1f} s of travel>").format(r.poses.size(), r.travel_seconds());
      });
}

}  // namespace posewright::python
