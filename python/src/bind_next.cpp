#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.hpp"
#include "keywords.hpp"
#include "made.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/next.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/text_file.hpp"
#include "posewright/tasks/next_state.hpp"

namespace posewright::python {

/// Next poses with what was said before them.
struct NextStep {
  NextPoses next;
  std::vector<NextPoint> history;
};
using MadeNext = Made<NextStep, NextOptions>;

static std::string text_of(const MadeNext& m) { return next_text(m.value.next); }
static auto json_of(const MadeNext& m) {
  return next_json(m.problem->problem, m.options.seed, m.options.measured_file(), m.value.next, m.value.history);
}

namespace {

constexpr std::uintmax_t largest_data = 1'000'000'000;

/// The file's whole lines; a file that is not there yet has none.
WholeLines lines_of(const std::filesystem::path& file) {
  std::error_code code;
  if (file.empty() || !std::filesystem::exists(file, code)) return {};
  return whole_lines(read_text(file, largest_data));
}

NextStep step_of(const Problem& problem, NextOptions& options, const std::filesystem::path& state_file, bool anew,
                 const Monitor& monitor) {
  const WholeLines lines = lines_of(options.data);
  std::optional<NextState> state;
  if (!state_file.empty() && !anew) state = read_next_state(state_file);
  if (state) require_continues(*state, state_file, problem, options.data, lines.text);
  if (lines.has_rows) options.text = lines.text;
  if (state) reuse(*state, problem, options);
  NextStep step{next_poses(problem, options, monitor), {}};
  const NextState now = state_after(problem, options, step.next, state);
  step.history = now.history;
  if (!state_file.empty()) write_file_atomically(state_file, next_state_text(now));
  return step;
}

MadeNext next_poses_of(const Shared& problem, const py::object& data, const py::object& poses,
                       const py::kwargs& named) {
  Keywords keywords(named);
  if (!data.is_none()) keywords.set("data", py::str(data));
  keywords.set("poses", poses);
  NextOptions options;
  keywords.read(next_options(), options);
  if (const py::object list = keywords.take("candidates_from"); !list.is_none())
    options.candidates_from = pose_list(list, without_limits(coordinates_of(*problem, options.variant)));
  const std::filesystem::path state_file = keywords.text("state");
  const bool anew = keywords.flag("restart");
  const Limit limit = keywords.time_limit();
  keywords.finish();
  return MadeNext::of(problem, std::move(options), limit, keywords.progress,
                      [&](const Problem& p, NextOptions& o, const Monitor& monitor) {
                        return step_of(p, o, state_file, anew, monitor);
                      });
}

}  // namespace

void bind_next(py::module_& m) {
  using N = MadeNext;
  const auto now = [](std::optional<double> NextPoint::*which) {
    return [which](const N& n) -> std::optional<double> {
      const std::vector<NextPoint>& curve = n.value.next.curve;
      return curve.empty() ? std::nullopt : curve.back().*which;
    };
  };
  bind_made<N>(m, "NextPoses", "Which poses to measure next, and whether to go on; docs/next.md.")
      .def_property_readonly(
          "configurations", [](const N& n) { return pose_configurations(n.value.next.poses); },
          "N × n, SI, without load cases and stations")
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
            return dict_of(
                n.value.next.estimates, [](const EstimatedValue& e) { return e.value.name; },
                [](const EstimatedValue& e) { return e.value.value; });
          },
          "{parameter: value} of the fit so far, SI")
      .def_property_readonly("notes", [](const N& n) { return n.value.next.notes; })
      .def("__len__", [](const N& n) { return n.value.next.poses.size(); })
      .def("__repr__", [](const N& n) {
        return py::str("<NextPoses after {}: {}>").format(n.value.next.measured, verdict_name(n.value.next.verdict));
      });
  define(m, "next_poses", &next_poses_of,
         documentation("next_poses", "problem: Problem, data: object = None, poses: int = 1, *",
                       rows_of(next_options()), {"data", "poses"}, false, run_arguments, "NextPoses",
                       R"(Fits the readings so far, chooses the next poses, reports when to stop (docs/next.md).

data: the file of readings, whole lines count; None or no such file: no pose is measured; required without unit: m;
state: a file that is read and written anew, so that candidates are drawn once and other data are noticed.)"),
         py::arg("problem"), py::arg("data") = py::none(), py::arg("poses") = 1);
}

}  // namespace posewright::python
