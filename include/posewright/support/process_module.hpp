#pragma once

#include "posewright/support/workers.hpp"

namespace posewright {

/// What the module for several processes gives: workers that its caller deletes.
using MakeWorkers = Workers*();
inline constexpr const char* make_workers_name = "posewright_make_workers";

}  // namespace posewright
