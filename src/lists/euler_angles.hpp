#pragma once

#include <array>
#include <string>
#include <vector>

#include "posewright/model/euler_turns.hpp"

namespace posewright {

/// An orientation as three angles in columns in the order of the turns, pose.fixed_xyz.1, .2, .3 or
/// pose.moving_zyz.1, .2, .3.
struct EulerAngles : EulerTurns {
  std::array<std::string, 3> columns;
};

/// The conventions whose three columns are all there.
std::vector<EulerAngles> euler_angles_of(const std::vector<std::string>& columns);

}  // namespace posewright
