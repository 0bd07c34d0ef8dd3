#pragma once

#include "posewright/planning/workspace_bound.hpp"

namespace posewright {

/// Proves the largest d of these weights over the limits of the axes, where the space says what bounds d (theory.md eq.
/// (37), (39)) and the candidates are no quick look (fewer than 1,000, unless a proof costs next to nothing): fills
/// `found.proof`. Beside those limits it counts what points on bodies tell of feasible configurations (eq. (58)).
/// @param candidates  how many there are
/// @param rows  of a block
void prove_workspace(WorkspaceBound& found, const ConfigurationSpace& space, std::size_t candidates, int rows,
                     const WorkspaceBoundOptions& options, const Monitor& monitor);

/// prove_workspace(), and as long as a box shows a feasible configuration whose d exceeds what searches found, again
/// with weights that know it.
/// @param found  of workspace_bound() on the same blocks
void settle_workspace(WorkspaceBound& found, const BlockArray& blocks, const ApproximateDesign& on_candidates,
                      const InformationFunction& function, const ConfigurationSpace& space,
                      WorkspaceBoundOptions options, const Monitor& monitor);

}  // namespace posewright
