#pragma once

#include "posewright/planning/workspace_bound.hpp"

namespace posewright {

/// Proves the largest d of these weights over the limits of the axes, where the space says what bounds d (theory.md eq.
/// (37), (39)) and the candidates are no quick look (fewer than 1,000, unless a proof costs next to nothing): fills
/// `found.proof`. Obstacles and lines of sight only shrink the set: they are not used.
/// @param candidates  how many there are
/// @param rows  of a block
void prove_workspace(WorkspaceBound& found, const ConfigurationSpace& space, std::size_t candidates, int rows,
                     const WorkspaceBoundOptions& options, const Monitor& monitor);

}  // namespace posewright
