#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <optional>
#include <string>

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

/// Progress.
void bind_progress(py::module_& m);

}  // namespace posewright::python
