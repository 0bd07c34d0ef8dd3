#pragma once

#include <vector>

#include "posewright/cell/cell.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// The robot's coordinates with the problem file's limits applied, the margin not. Throws InputError, see Workspace.
/// @param cell  where a robot that is not calibrated yet keeps more room; null: it does not
std::vector<Coordinate> limits_in_force(const IdentificationModel& model, const Problem& problem, const Cell* cell);

/// What is left of `in_force` inside the margin: where configurations are proposed. A margin that nobody asked for is
/// kept from the robot's own limits only, and leaves out no listed position.
/// Throws InputError if nothing is left inside a margin that was asked for.
std::vector<Coordinate> proposed_limits(const IdentificationModel& model, const Problem& problem,
                                        std::vector<Coordinate> in_force);

}  // namespace posewright
