#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// A pose whose targets were read as each other.
struct MixedTargets {
  int id = 0;                    ///< of the pose
  std::vector<std::string> are;  ///< names of the targets that are in the columns, in the order of the columns
};

/// Poses whose targets have the distances from each other that the median pose has only if they change places: no model
/// of the robot is asked, since targets sit on one body. Fewer than a quarter of the poses, of five at least; distances
/// off by more than twenty times their scatter (median absolute deviation, as σ).
/// @param names  of the targets; readings are their x, y, z in this order
std::vector<MixedTargets> mixed_targets(const std::vector<std::string>& names, const std::vector<MeasuredPose>& poses);

}  // namespace posewright
