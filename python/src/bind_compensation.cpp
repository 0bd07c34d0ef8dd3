#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.hpp"
#include "keywords.hpp"
#include "made.hpp"
#include "posewright/model/calibrated_values.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/calibrated_dh_table.hpp"
#include "posewright/results/compensation.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/compensate_documents.hpp"

namespace posewright::python {

using MadeCompensation = Made<CompensatedDocuments, CompensateCall>;

static std::optional<DhTable> table_of(const MadeCompensation& m) {
  if (!m.options.dh) return std::nullopt;
  const Problem& problem = m.problem->problem;
  const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
  if (arm == nullptr) throw InputError({}, "dh is for serial arms", "robot: urdf");
  const VariantSpec& variant = find_variant(problem, problem.parameters->variant.value);
  return dh_table(*arm, problem.at(arm->line), variant.convention,
                  calibrated_values({problem, variant}, *make_model({problem, variant}), {}), *m.options.dh);
}
static std::string text_of(const MadeCompensation& m) {
  const std::optional<DhTable> table = table_of(m);
  return compensation_text(m.value.result) + (table ? "\n" + dh_table_text(*table) : "");
}
static auto json_of(const MadeCompensation& m) {
  auto json = compensation_json(m.problem->problem, m.value.result);
  if (const std::optional<DhTable> table = table_of(m)) json["denavit_hartenberg"] = dh_table_json(*table);
  return json;
}

namespace {

MadeCompensation compensate(const Shared& problem, const py::object& poses, const py::kwargs& named) {
  if (!problem->problem.parameters)
    throw InputError({}, "problem has no calibrated parameters", "Problem(..., parameters=FILE)");
  Keywords keywords(named);
  CompensateCall call;
  keywords.read(compensate_options(), call);
  keywords.finish();
  std::vector<std::filesystem::path> files;
  if (const auto file = file_name(poses)) files.push_back(*file);
  PoseList list;
  if (files.empty())
    list = pose_list(poses, with_places(*problem, [&] { return compensation_coordinates(problem->problem); }),
                     call.reading.format);
  return MadeCompensation::of(problem, call, {}, keywords.progress,
                              [&](const Problem& p, const CompensateCall& o, const Monitor& monitor) {
                                if (!files.empty()) return compensate_documents(p, files, o, monitor);
                                return CompensatedDocuments{compensate_problem(p, {list}, o, monitor), true, {}};
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
  return pose_rows(made.value.result, made.value.result.coordinates.size(),
                   [](const CompensatedList& list, std::size_t i) {
                     const auto q = list.configuration(i);
                     return std::vector<double>(q.begin(), q.end());
                   });
}

py::object commanded_actuators(const MadeCompensation& made) {
  if (!made.value.result.parallel) return py::none();
  const std::size_t width = made.value.result.axes.size();
  return pose_rows(made.value.result, width, [&](const CompensatedList& list, std::size_t i) {
    const auto first = list.actuators.begin() + std::ptrdiff_t(i * width);
    return std::vector<double>(first, first + std::ptrdiff_t(width));
  });
}

}  // namespace

void bind_compensation(py::module_& m) {
  using C = MadeCompensation;
  const auto errors = [](TipError CommandSolver::Solution::*which) {
    return [which](const C& c) {
      return pose_rows(c.value.result, 2, [&](const CompensatedList& list, std::size_t i) {
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
            return of_each(c.value.result.lists.front().solutions, [](const CommandSolver::Solution& s) {
              return s.outcome == CommandSolver::Outcome::reached;
            });
          },
          "of each pose")
      .def_property_readonly("before", errors(&CommandSolver::Solution::before),
                             "N × 2: predicted error of the tip (m, rad), commanded as listed")
      .def_property_readonly("after", errors(&CommandSolver::Solution::after), "N × 2: the same, commanded so")
      .def_property_readonly(
          "failures", [](const C& c) { return of_each(c.value.result.failures, &NotCompensated::text); },
          "poses that cannot be commanded, and why")
      .def_property_readonly(
          "text",
          [](const C& c) { return c.value.texts.empty() ? py::object(py::none()) : py::cast(c.value.texts.front()); },
          "the file with the joints to command; None for an array, a plan, or where poses are not compensated")
      .def_property_readonly("notes", [](const C& c) { return c.value.result.notes; })
      .def("__repr__", [](const C& c) {
        return py::str("<Compensation of {} poses, {} not compensated>")
            .format(c.value.result.lists.front().solutions.size(), c.value.result.failures.size());
      });
  define(
      m, "compensate", &compensate,
      documentation("compensate", "problem: Problem, poses: object, *", rows_of(compensate_options()), {}, false,
                    ", threads: int = 0, progress: object = None", "Compensation",
                    "Commands for the calibrated robot, so that it reaches the poses that were meant for the nominal "
                    "one (docs/compensate.md). problem: with parameters; poses: an array, a plan, or the name of a "
                    "pose list or robot program."),
      py::arg("problem"), py::arg("poses"));
}

}  // namespace posewright::python
