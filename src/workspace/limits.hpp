#pragma once

#include <vector>

#include "posewright/cell/cell.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// The robot's coordinates with the problem file's limits and margins applied. Throws InputError, see Workspace.
/// @param cell  where a robot that is not calibrated yet keeps more room; null: it does not
std::vector<Coordinate> limits_in_force(const IdentificationModel& model, const Problem& problem, const Cell* cell);

}  // namespace posewright
