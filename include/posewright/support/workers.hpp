#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace posewright {

/// A task of a long computation: its result depends on the index alone, not on the thread `worker` of its process.
using Task = std::function<std::string(std::size_t index, int worker)>;
/// What to do with a result.
using TaskResult = std::function<void(std::size_t index, std::string_view bytes)>;

/// Who computes tasks: the threads of this process, or those of several processes that all run the same program on the
/// same input and meet here (support/tasks.hpp).
class Workers {
 public:
  virtual ~Workers() = default;
  /// This process among all; 0 hands out the tasks, and is the one that writes.
  virtual int rank() const = 0;
  virtual int processes() const = 0;
  /// Computes the tasks of `indices`, with so many threads in each process. Results come to process 0, one call at a
  /// time, in any order. A task that throws ends the computation with its exception on the process that computed it.
  virtual void compute(const std::vector<std::size_t>& indices, int threads, const Task& task,
                       const TaskResult& finished) = 0;
  /// Gives every process the bytes of process 0.
  virtual void share(std::string& bytes) = 0;

  /// What went between the processes so far, as the first one knows it.
  struct Traffic {
    long messages = 0, bytes = 0;
  };
  virtual Traffic traffic() const = 0;

  /// The end of this process: waits for the others; after an error no longer than a moment, then all are ended.
  virtual void leave(int exit_code) = 0;
};

/// The threads of this process.
std::unique_ptr<Workers> thread_workers();

}  // namespace posewright
