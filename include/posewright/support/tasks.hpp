#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/support/monitor.hpp"
#include "posewright/support/task_log.hpp"
#include "posewright/support/workers.hpp"

namespace posewright {

/// Tasks of one kind that a computation splits into.
struct TaskGroup {
  std::string name;       ///< for progress and logs: "draws"
  std::size_t count = 0;  ///< indices 0 … count − 1
  int threads = 0;        ///< in each process, 0 = all
  /// Told of each result as it comes, in any order, on process 0; empty: progress is told by number.
  TaskResult finished{};
  bool first_always = false;  ///< task 0 is done however early a stop comes
};

/// Workers of a computation's tasks (threads, or processes), known results (a log of an earlier run
/// that was cut short), and which of them are this run's share. A Monitor carries it into a computation.
class TaskEngine {
 public:
  /// Tasks of this run: those with index ≡ part − 1 (mod parts).
  struct Shard {
    int part = 1, parts = 1;
  };

  /// @param log  where finished tasks are kept; null: nowhere
  explicit TaskEngine(std::shared_ptr<Workers> workers, std::unique_ptr<TaskLog> log = nullptr,
                      std::optional<Shard> shard = {});

  Workers& workers() { return *workers_; }
  bool writes() const { return workers_->rank() == 0; }
  /// Tasks that the log had, and that this run computed.
  long known() const { return known_; }
  long computed() const { return computed_; }

  /// As run_tasks.
  bool run(const TaskGroup& group, const Task& task, const TaskResult& merge, const Monitor& monitor);

 private:
  using Results = std::map<std::size_t, std::string>;
  /// All results that there are after this group, on every process; the first error of the lowest index is thrown.
  Results results_of(const TaskGroup& group, const Task& task, const Monitor& monitor, bool& stopped);

  std::shared_ptr<Workers> workers_;
  std::unique_ptr<TaskLog> log_;
  std::optional<Shard> shard_;
  int groups_ = 0;
  long known_ = 0, computed_ = 0;
};

/// This run's share is done, and the rest is another's: merge the logs.
struct ShardDone {
  std::string group;
  std::size_t done = 0, of = 0;
};

/// True if tasks are shared with other processes: then no clock may end the common computation.
inline bool several_processes(const Monitor& monitor) {
  return monitor.engine != nullptr && monitor.engine->workers().processes() > 1;
}

/// Runs task(i) for every index of the group, then merge(i, bytes) in order of i, on every process alike; so everything
/// that follows is the same for any number of threads and processes. After a stop tasks that were not begun are left
/// out, and results that came after it are not logged: they may be cut short.
/// @return whether there was a stop; the same answer on every process
/// Throws what a task threw (the lowest index that threw), and ShardDone where other shards' results are missing.
bool run_tasks(const TaskGroup& group, const Task& task, const TaskResult& merge, const Monitor& monitor);

}  // namespace posewright
