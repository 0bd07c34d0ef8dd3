#pragma once

#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// True if each campaign has a tool of its own, by F of the parameters that it adds where the noise is rejected.
/// @param options  with the base moved between campaigns
bool is_tool_remounted(const Problem& problem, CalibrateOptions options, const Monitor& monitor);

}  // namespace posewright
