#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arguments.hpp"
#include "arrays.hpp"
#include "made.hpp"
#include "posewright/results/compensation.hpp"

namespace posewright::python {

using MadeCompensation = Made<Compensation, CompensateOptions>;

static std::string text_of(const MadeCompensation& m) { return compensation_text(m.value); }
static auto json_of(const MadeCompensation& m) { return compensation_json(m.problem->problem, m.value); }

namespace {

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

}  // namespace

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
  const py::none none;
  m.def("compensate", &compensate, py::arg("problem"), py::arg("poses"), py::kw_only(), py::arg("base") = false,
        py::arg("tool") = true, py::arg("position_only") = false, py::arg("elastic_target") = false,
        py::arg("most") = CommandSolver::Options{}.most_angle, py::arg("format") = "", py::arg("threads") = 0,
        py::arg("progress") = none,
        R"(Commands for the calibrated robot, so that it stands where the nominal one was meant to (docs/compensate.md).

problem: with parameters; base, tool: what was found of them counts; position_only: orientations may be what they will;
elastic_target: the poses were found with the nominal springs; most: largest turn that is a correction, rad.)");
}

}  // namespace posewright::python
