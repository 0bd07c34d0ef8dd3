#include "posewright/support/memory_limit.hpp"

#include <emscripten/heap.h>

namespace posewright {

// What 32 bits address; 2^32 itself is 0 there.
std::uint64_t memory_limit() {
  const std::size_t most = emscripten_get_heap_max();
  return most == 0 ? std::uint64_t(1) << 32 : most;
}

}  // namespace posewright
