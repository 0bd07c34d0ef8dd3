#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// First fit of base and tool alone, of the first campaign and then of what moved before each further one.
/// @param model  with campaigns (with_campaigns()) if there are any
/// @param campaigns  none: one file
/// @return corrections of all parameters
std::vector<double> placed_campaigns(const IdentificationModel& model, const VariantColumns& all,
                                     const std::vector<MeasuredPose>& poses, const std::vector<std::string>& campaigns,
                                     const FitOptions& options);

/// True if each campaign has a tool of its own, by F of the parameters that it adds where the noise is rejected.
/// @param options  with the base moved between campaigns
bool is_tool_remounted(const Problem& problem, CalibrateOptions options, const Monitor& monitor);

}  // namespace posewright
