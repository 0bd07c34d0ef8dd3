#pragma once

#include <cstddef>
#include <functional>

namespace posewright {

/// Threads to use when asked for `requested` (0 = all the machine has).
int thread_count(int requested);

/// Calls body(index, worker) for every index in [0, count), worker in [0, threads). Tasks are handed out in order;
/// which worker gets which is not fixed, so results must depend on the index alone. The first exception (lowest
/// index seen) is rethrown after all workers have stopped. With one thread everything runs on the caller's.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, int)>& body);

}  // namespace posewright
