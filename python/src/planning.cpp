#include <pybind11/stl.h>

#include "bindings.hpp"
#include "keywords.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"

namespace posewright::python {
namespace {

py::object plan(const GivenProblem& given, const py::object& poses, const py::kwargs& named) {
  Keywords keywords(named);
  keywords.set("poses", poses);
  PlanCall call;
  keywords.read(plan_options(), call);
  const std::optional<double> limit = keywords.time_limit();
  const auto problem = keywords.designed(given, {}, call.run);
  call.run.other_numbers = true;
  const auto search = [&](const auto& work) {
    return watched(given, limit, keywords.progress, OnInterrupt::keep_best, work);
  };
  Plan first = search([&](const Monitor& monitor) { return plan_problem(problem->problem, call.run, monitor); });
  py::object validation = py::none();
  if (call.validation)
    validation = py::cast(search([&](const Monitor& monitor) {
      return plan_validation(problem->problem, call.run, first, *call.validation, monitor);
    }));
  py::object result = py::cast(std::move(first));
  result.attr("validation") = validation;
  return result;
}

PoseListEvaluation evaluate(const GivenProblem& given, const py::object& poses, const py::kwargs& named) {
  Keywords keywords(named);
  EvaluateCall call;
  keywords.read(evaluate_options(), call);
  const std::optional<double> limit = keywords.time_limit();
  const auto problem = keywords.designed(given, {"poses"}, call.options.run);
  const std::vector<Coordinate> coordinates = coordinates_of(*problem);
  const auto file = file_name(poses);
  const PoseList list = file ? poses_to_evaluate(file->string(), coordinates, call.reading)
                             : pose_list(poses, coordinates, call.reading.format);
  return watched(given, limit, keywords.progress, OnInterrupt::raise, [&](const Monitor& monitor) {
    return evaluate_problem(problem->problem, list, call.options, monitor);
  });
}

py::dict observe(const GivenProblem& given, const py::object& variant, const py::kwargs& named) {
  Keywords keywords(named);
  keywords.set("variant", variant);
  ObserveOptions options;
  keywords.read(observe_options(), options);
  keywords.finish();
  auto found = watched(given, {}, keywords.progress, OnInterrupt::raise,
                       [&](const Monitor& monitor) { return observe_problem(given.problem, options, monitor); });
  py::dict result;
  for (Observation& observation : found) {
    const py::str name(observation.variant);
    result[name] = py::cast(std::move(observation));
  }
  return result;
}

Route route(const GivenProblem& given, const py::object& poses, const py::kwargs& named) {
  Keywords keywords(named);
  RouteOptions options;
  keywords.read(route_options(), options);
  const std::optional<double> limit = keywords.time_limit();
  const PoseList list = pose_list(poses, coordinates_of(given), keywords.text("from_"));
  keywords.finish();
  return watched(given, limit, keywords.progress, OnInterrupt::raise,
                 [&](const Monitor& monitor) { return route_problem(given.problem, list, options, monitor); });
}

}  // namespace

void bind_planning(py::module_& m) {
  const py::none none;
  define(m, "plan", &plan,
         documentation(
             "plan", "problem: Problem, poses: object = None, *", rows_of(plan_options()), {"poses"}, true,
             run_arguments, "Plan",
             R"(Searches for the poses to measure. Keywords are options of the command, and the keys of design in a
problem file (docs/problem-file-reference.md), a mapping's own ones with _ (require_accuracy="0.1 mm"); what is not
stated is as in the problem.

poses: their number, or "auto": the smallest that meets the requirements of the problem; measured (or augment), fixed,
candidates_from: Plan, file or array; time_limit: s; progress: called with a Progress. `validation` of the plan is the
plan of additional poses, or None.
The same problem, options and seed give the same plan, whatever the number of threads. Ctrl-C ends the search and returns
the best plan so far with a RuntimeWarning; a second one raises KeyboardInterrupt.)"),
         py::arg("problem"), py::arg("poses") = none);
  define(m, "evaluate", &evaluate,
         documentation(
             "evaluate", "problem: Problem, poses: object, *", rows_of(evaluate_options()), {"poses"}, true,
             run_arguments, "Evaluation",
             "Judges poses that you have: a Plan, the name of a pose list or robot program, or an array N × n in "
             "SI units. Other keywords are the keys of design, as in plan."),
         py::arg("problem"), py::arg("poses"));
  define(m, "observe", &observe,
         documentation("observe", "problem: Problem, variant: object = None, *", rows_of(observe_options()),
                       {"variant"}, false, ", seed: int = 0, threads: int = 0, progress: object = None",
                       "dict[str, Observation]", "Identifiability of one variant or of all: {variant: Observation}."),
         py::arg("problem"), py::arg("variant") = none);
  define(m, "route", &route,
         documentation(
             "route", "problem: Problem, poses: object, *", rows_of(route_options()), {}, false, run_arguments, "Route",
             "Order of measurement and collision-free motions for a Plan, the name of a pose list, or an array "
             "N × n."),
         py::arg("problem"), py::arg("poses"));
}

}  // namespace posewright::python
