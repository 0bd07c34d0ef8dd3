#pragma once

#include "posewright/lists/pose_list.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/simulation.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// A virtual experiment: measures the plan's poses (those measured before too) on a robot with drawn parameters,
/// calibrates as `calibrate` does, compares with the truth, again and again. A draw belongs to (seed, draw) alone.
/// Throws InputError for an unknown variant and an empty list; CannotDo if the poses do not determine
/// the parameters, where the truth does not reach a pose, and where no two draws could be calibrated.
Simulation simulate_problem(const Problem& problem, const PoseList& plan, const SimulateOptions& options,
                            const Monitor& monitor);

}  // namespace posewright
