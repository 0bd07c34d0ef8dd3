#pragma once

#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// The robot's coordinates with the problem file's limits and margins applied. Throws InputError, see Workspace.
std::vector<Coordinate> limits_in_force(const IdentificationModel& model, const Problem& problem);

}  // namespace posewright
