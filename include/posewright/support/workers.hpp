#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace posewright {

/// A task of a long computation: its result depends on the index alone, not on the thread `worker` of its process.
using Task = std::function<std::string(std::size_t index, int worker)>;
/// Receiver of a result.
using TaskResult = std::function<void(std::size_t index, std::string_view bytes)>;

/// Merges the data of two groups of processes; `lower` is of those with lower ranks.
using Join = std::function<std::string(std::string_view lower, std::string_view higher)>;

/// Workers for tasks: the threads of this process, or those of several processes that all run the same program on the
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
  /// Gives every process the bytes of process `from`, down a binomial tree.
  virtual void share_from(int from, std::string& bytes) = 0;
  /// Joins the data of all processes, in the order of their ranks and pair by pair up a binomial tree, and gives the
  /// result to all. Where `join` is associative the result does not depend on how many processes the parts are on.
  virtual void combine(std::string& bytes, const Join& join) = 0;

  /// Traffic between the processes so far.
  struct Traffic {
    long messages = 0, bytes = 0;

    static auto fields(auto& own) { return std::tie(own.messages, own.bytes); }
  };
  /// Traffic of all processes, known to the first one.
  virtual Traffic traffic() const = 0;
  /// Traffic of this process in share_from() and combine().
  virtual Traffic own_traffic() const = 0;

  /// The end of this process: waits for the others; after an error no longer than a moment, then all are ended.
  virtual void leave(int exit_code) = 0;
};

/// The threads of this process.
std::unique_ptr<Workers> thread_workers();

}  // namespace posewright
