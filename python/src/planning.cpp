#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "design_keywords.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"

namespace posewright::python {
namespace {

using Limit = std::optional<double>;

// Arguments that a function has beside the keys of the design.
const std::vector<std::string> of_plan{}, of_evaluate{"poses"};
const char* const search_arguments =
    ", seed: int = 0, threads: int = 0, time_limit: Optional[float] = None, progress: object = None";

Plan plan(const GivenProblem& given, const py::object& poses, std::optional<double> gap,
          std::optional<double> proof_time, const py::int_& seed, long long threads, Limit time_limit,
          py::object progress, py::kwargs design) {
  RunOptions run = run_options(seed, threads);
  if (gap && !(*gap > 0 && *gap < 100)) throw InputError({}, "gap is no percentage", "above 0 and below 100");
  if (proof_time && !(*proof_time >= 0 && *proof_time < 1e9))
    throw InputError({}, "proof_time is no number of seconds", "0 or more are allowed");
  if (gap) run.proof.gap = *gap / 100;
  run.proof.seconds = proof_time;
  design["poses"] = poses;
  const auto designed_problem = designed(given, design, of_plan, run);
  Plan result;
  Watch watch(time_limit, std::move(progress));
  watch.run(
      [&](const Monitor& monitor) {
        result = with_places(given, [&] { return plan_problem(designed_problem->problem, run, monitor); });
      },
      OnInterrupt::keep_best);
  return result;
}

PoseListEvaluation evaluate(const GivenProblem& given, const py::object& poses, const py::object& drop,
                            const py::object& add, const std::string& format, const py::int_& seed, long long threads,
                            Limit time_limit, py::object progress, const py::kwargs& design) {
  EvaluateOptions options;
  options.drop = optional_number(drop, "drop", most_poses);
  options.add = optional_number(add, "add", most_poses);
  options.run = run_options(seed, threads);
  const auto designed_problem = designed(given, design, of_evaluate, options.run);
  const PoseList list = pose_list(poses, coordinates_of(*designed_problem), format);
  PoseListEvaluation result;
  Watch watch(time_limit, std::move(progress));
  watch.run(
      [&](const Monitor& monitor) {
        result =
            with_places(given, [&] { return evaluate_problem(designed_problem->problem, list, options, monitor); });
      },
      OnInterrupt::raise);
  return result;
}

py::dict observe(const GivenProblem& given, const std::string& variant, long long candidates, const py::object& poses,
                 const py::int_& seed, long long threads, py::object progress) {
  ObserveOptions options;
  options.variant = variant;
  options.candidates = checked("candidates", candidates, 1, 1'000'000);
  options.poses = optional_number(poses, "poses", most_poses);
  options.seed = seed_of(seed);
  options.threads = checked("threads", threads, 0, most_threads);
  std::vector<Observation> found;
  Watch watch({}, std::move(progress));
  watch.run(
      [&](const Monitor& monitor) {
        found = with_places(given, [&] { return observe_problem(given.problem, options, monitor); });
      },
      OnInterrupt::raise);
  py::dict result;
  for (Observation& observation : found) {
    const py::str name(observation.variant);
    result[name] = py::cast(std::move(observation));
  }
  return result;
}

Route route(const GivenProblem& given, const py::object& poses, const std::string& format, bool from_home, bool closed,
            const py::object& start, const py::object& settle, const py::object& reading, long long milestones,
            const py::int_& seed, long long threads, Limit time_limit, py::object progress) {
  RouteOptions options;
  options.from_home = from_home;
  options.closed = closed;
  options.start = optional_number(start, "start", most_poses);
  options.settle = within(settle, "settle", 0, 3600);
  options.reading = within(reading, "reading", 0, 3600);
  options.milestones = checked("milestones", milestones, 1, 100000);
  options.seed = seed_of(seed);
  options.threads = checked("threads", threads, 0, most_threads);
  if (from_home && options.start)
    throw InputError({}, "start and from_home cannot be combined", "leave one of them out");
  const PoseList list = pose_list(poses, coordinates_of(given), format);
  Route result;
  Watch watch(time_limit, std::move(progress));
  watch.run(
      [&](const Monitor& monitor) {
        result = with_places(given, [&] { return route_problem(given.problem, list, options, monitor); });
      },
      OnInterrupt::raise);
  return result;
}

}  // namespace

void bind_planning(py::module_& m) {
  const py::none none;
  // Signatures come from the table of keys.
  py::options options;
  options.disable_function_signatures();
  m.def("plan", &plan, py::arg("problem"), py::arg("poses") = none, py::kw_only(), py::arg("gap") = none,
        py::arg("proof_time") = none, py::arg("seed") = 0, py::arg("threads") = 0, py::arg("time_limit") = none,
        py::arg("progress") = none,
        (signature("plan", "problem: Problem, poses: object = None, *", {"poses"},
                   std::string(", gap: Optional[float] = None, proof_time: Optional[float] = None") + search_arguments,
                   "Plan") +
         R"(Searches for the poses to measure. Keywords are the keys of design in a problem file
(docs/problem-file-reference.md), a mapping's own ones with _ (require_accuracy="0.1 mm"); what is not stated is as in
the problem.

poses: their number, or "auto": the smallest that reaches what the problem requires; measured (or augment), fixed,
candidates_from: Plan, file or array; time_limit: s; progress: called with a Progress; gap: percent at which the proof
over the workspace ends, proof_time: s for it, 0: none.
The same problem, options and seed give the same plan, whatever the number of threads. Ctrl-C ends the search and returns
the best plan so far with a RuntimeWarning; a second one raises KeyboardInterrupt.)")
            .c_str());
  m.def("evaluate", &evaluate, py::arg("problem"), py::arg("poses"), py::kw_only(), py::arg("drop") = none,
        py::arg("add") = none, py::arg("format") = "", py::arg("seed") = 0, py::arg("threads") = 0,
        py::arg("time_limit") = none, py::arg("progress") = none,
        (signature("evaluate",
                   "problem: Problem, poses: object, *, drop: Optional[int] = None, add: Optional[int] = None, "
                   "format: str = ''",
                   of_evaluate, search_arguments, "Evaluation") +
         R"(Judges poses that you have: a Plan, the name of a pose list, or an array N × n in SI units.

drop, add: which so many poses to leave out, or to measure more; format: of a list that another program wrote
(docs/export.md). Other keywords are the keys of design, as in plan.)")
            .c_str());
  options.enable_function_signatures();
  m.def("observe", &observe, py::arg("problem"), py::arg("variant") = "", py::kw_only(), py::arg("candidates") = 2000,
        py::arg("poses") = none, py::arg("seed") = 0, py::arg("threads") = 0, py::arg("progress") = none,
        "Identifiability of one variant or of all: {variant: Observation}.");
  m.def("route", &route, py::arg("problem"), py::arg("poses"), py::kw_only(), py::arg("format") = "",
        py::arg("from_home") = false, py::arg("closed") = false, py::arg("start") = none, py::arg("settle") = none,
        py::arg("reading") = none, py::arg("milestones") = 200, py::arg("seed") = 0, py::arg("threads") = 0,
        py::arg("time_limit") = none, py::arg("progress") = none,
        "Order of measurement and collision-free motions for a Plan, the name of a pose list (format as in evaluate), "
        "or an "
        "array N × n. settle: s at rest before a pose is read, reading: s of one reading; None: as in the problem.");
}

}  // namespace posewright::python
