#pragma once

#include "posewright/tasks/simulate_problem.hpp"

namespace posewright {

/// Fills `confirmed` and `verdict` from everything else: whether σ and intervals are as predicted, and, where they are
/// not, which causes the figures tell apart.
void judge_simulation(Simulation& simulation, const SimulateOptions& options);

}  // namespace posewright
