#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/problem/design_words.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"

namespace posewright::python {
namespace {

using Limit = std::optional<double>;

Plan plan(const GivenProblem& given, const py::object& poses, const std::string& criterion, const std::string& method,
          const std::string& variant, const py::object& candidates, const py::object& restarts,
          const py::object& repeats, const py::object& scaling, const py::object& prior, bool reserve,
          const py::object& measured, const py::object& fixed, const std::string& truth,
          const py::object& candidates_from, std::optional<double> gap, std::optional<double> proof_time,
          const py::object& robust, const std::string& robust_measure, const py::int_& seed, long long threads,
          Limit time_limit, py::object progress) {
  PlanOptions options;
  options.robust = robust_spec(optional_number(robust, "robust", most_robust_draws, least_robust_draws), robust_measure,
                               "robust_measure");
  options.truth = truth;
  if (py::isinstance<py::str>(poses)) options.smallest = !choice(poses, "poses", {"auto"}).empty();
  else options.poses = optional_number(poses, "poses", most_poses);
  options.criterion = criterion;
  options.method = method;
  options.variant = variant;
  set_search(options, candidates, restarts, seed, threads);
  options.repeats = repeats_of(repeats);
  if (const std::string text = choice(scaling, "scaling", {"tolerance", "norm", "none"}); !text.empty())
    options.scaling = scaling_of(text);
  if (const std::string text = choice(prior, "prior", {"none", "tolerance"}); !text.empty())
    options.prior = text == "tolerance";
  options.reserve = reserve;
  if (gap && !(*gap > 0 && *gap < 100)) throw InputError({}, "gap is no percentage", "above 0 and below 100");
  if (proof_time && !(*proof_time >= 0 && *proof_time < 1e9))
    throw InputError({}, "proof_time is no number of seconds", "0 or more are allowed");
  if (gap) options.proof.gap = *gap / 100;
  options.proof.seconds = proof_time;
  if (!measured.is_none() || !fixed.is_none() || !candidates_from.is_none()) {
    const std::vector<Coordinate> coordinates = coordinates_of(given, variant);
    if (!measured.is_none()) options.measured = pose_list(measured, coordinates);
    if (!fixed.is_none()) options.fixed = pose_list(fixed, coordinates);
    if (!candidates_from.is_none()) options.candidates_from = pose_list(candidates_from, without_limits(coordinates));
  }
  Plan result;
  Watch watch(time_limit, std::move(progress));
  watch.run(
      [&](const Monitor& monitor) {
        result = with_places(given, [&] { return plan_problem(given.problem, options, monitor); });
      },
      OnInterrupt::keep_best);
  return result;
}

PoseListEvaluation evaluate(const GivenProblem& given, const py::object& poses, const py::object& drop,
                            const py::object& add, const std::string& format, const std::string& variant,
                            const std::string& criterion, const std::string& method, const py::object& candidates,
                            const py::object& restarts, const py::int_& seed, long long threads, Limit time_limit,
                            py::object progress) {
  EvaluateOptions options;
  options.drop = optional_number(drop, "drop", most_poses);
  options.add = optional_number(add, "add", most_poses);
  options.plan.variant = variant;
  options.plan.criterion = criterion;
  options.plan.method = method;
  set_search(options.plan, candidates, restarts, seed, threads);
  const PoseList list = pose_list(poses, coordinates_of(given, variant), format);
  PoseListEvaluation result;
  Watch watch(time_limit, std::move(progress));
  watch.run(
      [&](const Monitor& monitor) {
        result = with_places(given, [&] { return evaluate_problem(given.problem, list, options, monitor); });
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
  m.def("plan", &plan, py::arg("problem"), py::arg("poses") = none, py::kw_only(), py::arg("criterion") = "",
        py::arg("method") = "", py::arg("variant") = "", py::arg("candidates") = none, py::arg("restarts") = none,
        py::arg("repeats") = none, py::arg("scaling") = none, py::arg("prior") = none, py::arg("reserve") = false,
        py::arg("measured") = none, py::arg("fixed") = none, py::arg("truth") = "", py::arg("candidates_from") = none,
        py::arg("gap") = none, py::arg("proof_time") = none, py::arg("robust") = none, py::arg("robust_measure") = "",
        py::arg("seed") = 0, py::arg("threads") = 0, py::arg("time_limit") = none, py::arg("progress") = none,
        R"(Searches for the poses to measure. What is not said is as in the problem.

poses: their number, or "auto": the smallest that reaches what the problem requires; measured: poses that are there
already (Plan, file or array); fixed: poses that the plan has among its own; candidates_from: choose among these (Plan, file or array); truth: an alternative model,
for criteria that test it; repeats: "forbid", "allow" or how often; time_limit: s; progress: called with a Progress;
gap: percent at which the proof over the workspace ends, proof_time: s for it, 0: none; robust: plan for so many robots
drawn from the tolerances, robust_measure: "mean", "worst" or "tail 0.1".
The same problem, options and seed give the same plan, whatever the number of threads. Ctrl-C ends the search and returns
the best plan so far with a RuntimeWarning; a second one raises KeyboardInterrupt.)");
  m.def("evaluate", &evaluate, py::arg("problem"), py::arg("poses"), py::kw_only(), py::arg("drop") = none,
        py::arg("add") = none, py::arg("format") = "", py::arg("variant") = "", py::arg("criterion") = "",
        py::arg("method") = "", py::arg("candidates") = none, py::arg("restarts") = none, py::arg("seed") = 0,
        py::arg("threads") = 0, py::arg("time_limit") = none, py::arg("progress") = none,
        R"(Judges poses that you have: a Plan, the name of a pose list, or an array N × n in SI units.

drop, add: which so many poses to leave out, or to measure more; format: of a list that another program wrote
(docs/export.md).)");
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
