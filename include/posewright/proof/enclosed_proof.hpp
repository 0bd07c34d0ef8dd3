#pragma once

#include "posewright/planning/workspace_bound.hpp"
#include "posewright/proof/bounded_space.hpp"

namespace posewright {

/// Proves the largest d of these weights over the limits of axes and actuators by Taylor models (largest_enclosed):
/// fills `found.proof`. False, and nothing is filled, if the space has no enclosure.
/// @param candidates  how many there are: with few a plan is a quick look, without a proof that takes seconds
/// @param rows  of a block
bool prove_by_enclosure(WorkspaceBound& found, const BoundedSpace& space, std::size_t candidates, int rows,
                        const WorkspaceBoundOptions& options, const Monitor& monitor);

}  // namespace posewright
