#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/support/result_store.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright::cli {

/// A long computation as a person at a terminal sees it: a line of progress on stderr, Ctrl-C ends the search and
/// keeps the best plan so far, a second Ctrl-C ends the program.
class Watch {
 public:
  /// @param seconds  time limit, 0 = none
  /// @param engine   who does the tasks of the computation; null: this process's threads
  Watch(const CommonOptions& common, double seconds, TaskEngine* engine = nullptr);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  const Monitor& monitor() const { return monitor_; }
  bool was_interrupted() const { return monitor_.was_interrupted(); }

 private:
  void show(const Progress& progress);
  std::optional<FolderStore> store_;
  Monitor monitor_;
  Monitor::Clock::time_point begin_, last_, stage_begin_;
  std::string stage_;
  bool shown_ = false;
};

/// Result of a computation under a Watch, and a mark for an early end by Ctrl-C.
template <class Result>
struct Watched {
  Result result;
  bool was_interrupted = false;
};

/// Ends the program with exit code `interrupted`: Ctrl-C came before there was anything to show.
struct Interrupted {};

/// Ends a process that is not the one that writes.
struct AnotherWrites {};

/// Output of --verbose about tasks: number of known ones, and traffic between processes; throws AnotherWrites.
void after_tasks(TaskEngine& engine, const CommonOptions& common);

/// Runs work(monitor) under a Watch. Throws Interrupted where the work gave up because of Ctrl-C, AnotherWrites on all
/// processes but the first.
/// @param seconds  time limit, 0 = none
template <class Work>
auto watched(const CommonOptions& common, double seconds, const Work& work, TaskEngine* engine = nullptr)
    -> Watched<decltype(work(std::declval<const Monitor&>()))> {
  const Watch watch(common, seconds, engine);
  try {
    auto result = work(watch.monitor());
    if (engine != nullptr) after_tasks(*engine, common);
    return {std::move(result), watch.was_interrupted()};
  } catch (const CannotDo&) {
    if (watch.was_interrupted()) throw Interrupted{};
    throw;
  }
}

/// Notes of a result, on stderr.
void print_notes(const std::vector<std::string>& notes);

/// Seconds of --time-limit; 0 if it is not given.
double time_limit(const po::variables_map& values);

/// --resume LOG, of commands whose tasks follow one from another.
po::options_description resume_option();
/// --resume LOG and --shard i/n, of commands whose work splits into tasks.
po::options_description task_options();

/// Engine of a command's tasks: the processes that the program was started as, with the log and the share that the
/// options name. Throws InputError for a share that is none or without a log, and for --time-limit with several
/// processes: they would stop at different places.
std::unique_ptr<TaskEngine> engine_of(const po::variables_map& values, const std::string& command);

}  // namespace posewright::cli
