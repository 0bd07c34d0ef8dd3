#pragma once

#include <mpi.h>

#include <chrono>
#include <functional>
#include <string>

#include "posewright/support/workers.hpp"

namespace posewright {

// Between two looks for a message no more time passes than this.
inline constexpr std::chrono::nanoseconds longest_pause = std::chrono::milliseconds(2);

/// Waits until the others are that far. MPI's own waiting keeps a core busy that another process of this machine may
/// need; this one looks often at first, and then adds no more than a part of what was waited for.
void wait_until(const std::function<bool()>& there);
void wait(MPI_Request& request);

/// A message that has come.
std::string received(const MPI_Status& status);

/// Messages between all processes along binomial trees, from one process to another, so that each can be counted: in a
/// tree of P processes every one but the root gets one message, and nobody sends more than ⌈log₂ P⌉.
class Tree {
 public:
  Tree(int rank, int processes) : rank_(rank), processes_(processes) {}

  void share(int from, std::string& bytes);
  void combine(std::string& bytes, const Join& join);

  /// On process 0.
  const Workers::Traffic& all() const { return all_; }
  const Workers::Traffic& own() const { return own_; }

 private:
  void send(const std::string& bytes, int to);
  std::string receive(int from);

  int rank_, processes_;
  Workers::Traffic all_, own_;
};

}  // namespace posewright
