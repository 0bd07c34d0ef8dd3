#include "posewright/support/parallel.hpp"

namespace posewright {

// This build has one thread, however many are asked for: results do not depend on their number.
int thread_count(int) { return 1; }

void parallel_for(std::size_t count, int, const std::function<void(std::size_t, int)>& body) {
  for (std::size_t i = 0; i < count; ++i) body(i, 0);
}

}  // namespace posewright
