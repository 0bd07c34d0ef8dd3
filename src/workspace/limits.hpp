#pragma once

#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {

/// Limits `in_force` less the margin, for proposed configurations. A default margin is
/// kept from the robot's own limits only, and leaves out no listed position.
/// Throws InputError if nothing is left inside a margin that was asked for.
std::vector<Coordinate> proposed_limits(const IdentificationModel& model, const Problem& problem,
                                        std::vector<Coordinate> in_force);

}  // namespace posewright
