#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// First fit of base and tool alone, of the first campaign and then of what moved before each further one.
/// @param model  with campaigns (with_campaigns()) if there are any
/// @param campaigns  none: one file
/// @return corrections of all parameters
std::vector<double> placed_campaigns(const IdentificationModel& model, const VariantColumns& all,
                                     const std::vector<MeasuredPose>& poses, const std::vector<std::string>& campaigns,
                                     const FitOptions& options);

}  // namespace posewright
