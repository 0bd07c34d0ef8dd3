#pragma once

#include <cstdint>

namespace posewright {

/// Bytes that this process may have at most: what the system has and allows, not what is free now.
std::uint64_t memory_limit();

}  // namespace posewright
