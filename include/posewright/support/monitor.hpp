#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace posewright {

class ResultStore;
class TaskEngine;

/// Progress of a long computation.
struct Progress {
  std::string stage;                 ///< "candidates", "certificate", "exchange", …
  double done = 0.0, total = 0.0;    ///< in units of the stage (restarts, samples); total 0 = unknown
  std::optional<double> best;        ///< criterion's value so far
  std::optional<double> bound;       ///< upper bound of it, same scale
  std::optional<double> efficiency;  ///< lower bound of the efficiency of `best`, in (0, 1]
};

/// The one channel between a long computation and its caller: progress out; stop, helping hands and results of
/// earlier computations in. Safe from
/// several threads.
class Monitor {
 public:
  using Clock = std::chrono::steady_clock;

  std::function<void(const Progress&)> on_progress;  ///< may be empty; calls are serialised
  const std::atomic<bool>* interrupted = nullptr;    ///< set by a signal handler or another thread
  std::optional<Clock::time_point> deadline;
  /// Engine of the tasks of run_tasks(); null: this process's threads. A computation inside a task has a monitor of its
  /// own, without one.
  TaskEngine* engine = nullptr;
  const ResultStore* store = nullptr;  ///< of drawn candidates; null: each computation draws its own

  /// Stops where the other does; nothing else is the other's.
  void stop_with(const Monitor& other) {
    interrupted = other.interrupted;
    deadline = other.deadline;
  }
  /// Stops where the other does, with the same helping hands; progress is its own.
  void follow(const Monitor& other) {
    stop_with(other);
    engine = other.engine;
    store = other.store;
  }
  /// Not after so many seconds from now.
  void end_within(double seconds) {
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    deadline = deadline ? std::min(*deadline, end) : end;
  }

  bool was_interrupted() const { return interrupted != nullptr && interrupted->load(std::memory_order_relaxed); }
  bool should_stop() const { return was_interrupted() || (deadline && Clock::now() >= *deadline); }
  void report(const Progress& progress) const {
    if (!on_progress) return;
    const std::scoped_lock lock(mutex_);
    on_progress(progress);
  }

 private:
  mutable std::mutex mutex_;
};

}  // namespace posewright
