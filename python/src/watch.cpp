#include <pybind11/stl.h>

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "bindings.hpp"
#include "posewright/support/error.hpp"

namespace posewright::python {
namespace {

using namespace std::chrono_literals;

// How long Ctrl-C may wait, and how often a progress function is called at most.
constexpr auto signal_interval = 50ms, progress_interval = 50ms;

}  // namespace

Watch::Watch(std::optional<double> time_limit, py::object progress) : progress_(std::move(progress)) {
  if (!progress_.is_none() && !PyCallable_Check(progress_.ptr()))
    throw py::type_error("progress must be a function of one argument, or None");
  monitor_.interrupted = &stop_;
  if (const std::filesystem::path folder = cache_folder(); !folder.empty()) monitor_.store = &store_.emplace(folder);
  if (time_limit) {
    if (!(*time_limit > 0) || !(*time_limit < 1e9))
      throw InputError({}, "time_limit is " + std::to_string(*time_limit), "a number of seconds above 0 is allowed");
    monitor_.end_within(*time_limit);
  }
  if (!progress_.is_none()) monitor_.on_progress = [this](const Progress& p) { report(p); };
}

void Watch::run(const std::function<void(const Monitor&)>& work, OnInterrupt on_interrupt) {
  std::exception_ptr error;
  {
    const py::gil_scoped_release release;
    std::mutex mutex;
    std::condition_variable finished;
    bool done = false;
    const std::jthread worker([&] {
      try {
        work(monitor_);
      } catch (...) {
        error = std::current_exception();
      }
      const std::scoped_lock lock(mutex);
      done = true;
      finished.notify_one();
    });
    std::unique_lock lock(mutex);
    while (!finished.wait_for(lock, signal_interval, [&] { return done; })) {
      lock.unlock();
      look_for_signals();
      lock.lock();
    }
  }
  finish(error, on_interrupt);
}

void Watch::look_for_signals() {
  const py::gil_scoped_acquire acquire;
  // Python runs its handlers here, and only on its main thread.
  if (PyErr_CheckSignals() == 0) return;
  py::error_already_set raised;
  stop_ = true;
  if (raised.matches(PyExc_KeyboardInterrupt) && ++interrupts_ == 1) return;
  if (!raised_) raised_.emplace(std::move(raised));
}

void Watch::finish(const std::exception_ptr& error, OnInterrupt on_interrupt) {
  if (raised_) throw py::error_already_set(*raised_);
  if (interrupts_ > 0 && (error || on_interrupt == OnInterrupt::raise)) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  if (error) std::rethrow_exception(error);
  if (interrupts_ > 0 && PyErr_WarnEx(PyExc_RuntimeWarning, "interrupted: this is the best plan so far", 1) != 0)
    throw py::error_already_set();
}

bool Watch::is_due(const Progress& progress) {
  const auto now = Monitor::Clock::now();
  const bool last = progress.total > 0 && progress.done >= progress.total;
  if (progress.stage == stage_ && !last && now - last_ < progress_interval) return false;
  stage_ = progress.stage;
  last_ = now;
  return true;
}

void Watch::report(const Progress& progress) {
  if (stop_ || !is_due(progress)) return;
  const py::gil_scoped_acquire acquire;
  try {
    progress_(progress);
  } catch (py::error_already_set& raised) {
    // It must not pass through the search's threads: the calling thread raises it when they have stopped.
    if (!raised_) raised_.emplace(std::move(raised));
    stop_ = true;
  }
}

void bind_progress(py::module_& m) {
  py::class_<Progress>(m, "Progress", "Progress of a long computation.")
      .def_readonly("stage", &Progress::stage, "candidates, certificate, exchange, …")
      .def_readonly("done", &Progress::done, "in units of the stage")
      .def_readonly("total", &Progress::total, "in units of the stage; 0: not known")
      .def_readonly("best", &Progress::best, "criterion's value so far, or None")
      .def_readonly("bound", &Progress::bound, "upper bound of it, or None")
      .def_readonly("efficiency", &Progress::efficiency, "lower bound of what `best` reaches of the optimum, or None")
      .def("__repr__",
           [](const Progress& p) { return py::str("<Progress {}: {:g} of {:g}>").format(p.stage, p.done, p.total); });
}

}  // namespace posewright::python
