#include <pybind11/stl.h>

#include "bindings.hpp"
#include "planners/planner_registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/support/table.hpp"
#include "posewright/version.hpp"

namespace posewright::python {

void bind_criteria(py::module_& m) {
  m.def(
      "criteria", [] { return dict_of(criterion_registry(), &CriterionEntry::name, &CriterionEntry::summary); },
      "Names of the criteria, each with what it maximises.");
  m.def(
      "methods", [] { return dict_of(planner_registry(), &Planner::name, &Planner::summary); },
      "Names of the planners, each with what it does.");
  m.def("_shown", &shown_value, py::arg("value"), py::arg("unit"), "A value in SI as tables show it.");
}

}  // namespace posewright::python

PYBIND11_MODULE(_core, m) {
  using namespace posewright::python;
  m.doc() = "The compiled part of posewright.";
  m.attr("__version__") = posewright::version;
  bind_errors(m);
  bind_progress(m);
  bind_criteria(m);
  bind_plan(m);
  bind_problem(m);
  bind_model(m);
  bind_planning(m);
  bind_evaluation(m);
  bind_observation(m);
  bind_route(m);
  bind_blocks(m);
  bind_tasks(m);
  bind_compensation(m);
  bind_next(m);
  bind_export(m);
}
