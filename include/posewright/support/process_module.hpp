#pragma once

#include "posewright/support/workers.hpp"

namespace posewright {

/// Result of the module for several processes: workers that its caller deletes.
using MakeWorkers = Workers*();
inline constexpr const char* make_workers_name = "posewright_make_workers";

}  // namespace posewright
