#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posewright/lists/pose_list.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/support/result_store.hpp"

namespace posewright::python {

namespace py = pybind11;

/// Effect of Ctrl-C on a computation.
enum class OnInterrupt { keep_best, raise };

/// A long computation as Python sees it: it runs on a thread of its own without the interpreter's lock, while the
/// calling thread looks for signals; progress calls a Python function.
class Watch {
 public:
  /// @param time_limit  s; none: no limit. Throws InputError unless it is positive.
  /// @param progress    called with a Progress, or None
  Watch(std::optional<double> time_limit, py::object progress);

  /// Runs the work. Throws what it throws, what the progress function raised, and KeyboardInterrupt: with keep_best
  /// only where Ctrl-C came twice or nothing was found yet; else it warns that the result is the best so far.
  void run(const std::function<void(const Monitor&)>& work, OnInterrupt on_interrupt);

 private:
  void report(const Progress& progress);
  bool is_due(const Progress& progress);
  void look_for_signals();
  void finish(const std::exception_ptr& error, OnInterrupt on_interrupt);

  std::optional<FolderStore> store_;
  Monitor monitor_;
  py::object progress_;
  std::atomic<bool> stop_{false};
  std::optional<py::error_already_set> raised_;  // by the progress function or a signal handler
  int interrupts_ = 0;
  Monitor::Clock::time_point last_{};
  std::string stage_;
};

/// A problem, and what its lines stand for where it was not a file.
struct GivenProblem {
  Problem problem;
  /// Key path of each line, first line first; empty: the lines are those of a file.
  std::vector<std::string> places;
};

/// A variant ready to give Jacobian blocks.
struct GivenModel {
  std::shared_ptr<const GivenProblem> problem;
  Variant variant;
};

/// Whitened blocks with their labels.
struct Blocks {
  std::shared_ptr<const BlockArray> array;
  std::vector<Parameter> parameters;
  int nuisance = 0;
};

/// The error's text with `file: key path` for `file:line`, where the keys are known; as it is for other files.
std::string place_in_keys(const InputError& error, const std::string& file, const std::vector<std::string>& places);
/// Runs `work`; errors that name a line of a problem that was not a file name its key path instead.
template <class Work>
auto with_places(const GivenProblem& problem, Work&& work) {
  try {
    return work();
  } catch (const InputError& error) {
    if (problem.places.empty()) throw;
    throw InputError({}, place_in_keys(error, problem.problem.file.string(), problem.places), "");
  }
}

/// None where the value is not text and no path.
std::optional<std::filesystem::path> file_name(const py::object& value);
/// Coordinates that lists of this problem are read with.
inline std::vector<Coordinate> coordinates_of(const GivenProblem& given, const std::string& variant = "") {
  return with_places(given, [&] { return pose_coordinates(given.problem, variant); });
}
/// A Plan, a file's name (with the format of a list that another program wrote), or an array of configurations.
PoseList pose_list(const py::object& poses, const std::vector<Coordinate>& coordinates, const std::string& format = "");
/// The kept columns of a plan's variant.
std::vector<std::string> kept_parameters(const Plan& plan, const std::string& variant);

/// value(entry) of each entry of a list.
template <class List, class Value>
auto of_each(const List& list, Value value) {
  std::vector<std::decay_t<decltype(std::invoke(value, *list.begin()))>> result;
  for (const auto& entry : list) result.push_back(std::invoke(value, entry));
  return result;
}
/// {key(entry): value(entry)} of a list.
template <class List, class Key, class Value>
py::dict dict_of(const List& list, Key key, Value value) {
  py::dict result;
  for (const auto& entry : list) result[py::cast(std::invoke(key, entry))] = std::invoke(value, entry);
  return result;
}
/// As Python sees a parameter for which nothing is planned.
inline PlannedParameter unplanned(const Parameter& label) { return {label, "", std::nullopt, ""}; }
/// N × n, SI, without load cases and stations.
py::array_t<double> pose_configurations(const std::vector<PlannedPose>& poses);

/// json.loads.
py::object parsed(const std::string& json);
/// Throws FileExistsError where there is a file, unless `overwrite`.
void require_absent(const std::filesystem::path& file, bool overwrite);
/// Writes text. Throws as require_absent().
void save_text(const py::object& path, const std::string& text, bool overwrite);
/// {"o1": …, …}
py::dict indices_dict(const ObservabilityIndices& indices);
/// A plan in one line.
std::string plan_line(const Plan& plan);

void bind_errors(py::module_& m);
void bind_progress(py::module_& m);
void bind_problem(py::module_& m);
void bind_model(py::module_& m);
void bind_plan(py::module_& m);
void bind_planning(py::module_& m);
void bind_evaluation(py::module_& m);
void bind_observation(py::module_& m);
void bind_route(py::module_& m);
void bind_blocks(py::module_& m);
void bind_criteria(py::module_& m);
void bind_tasks(py::module_& m);
void bind_compensation(py::module_& m);
void bind_next(py::module_& m);
void bind_export(py::module_& m);

}  // namespace posewright::python
