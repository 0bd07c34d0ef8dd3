#pragma once

#include <vector>

#include "posewright/tasks/simulate_problem.hpp"

namespace posewright {

/// Fills `confirmed` and `verdict` from everything else: whether σ and intervals are as predicted, and, where they are
/// not, which causes the figures tell apart.
void judge_simulation(Simulation& simulation, const SimulateOptions& options);

/// Rejections by several tests, so that the probability of any false rejection is at most `level`, however they
/// depend on each other: Holm, Scandinavian Journal of Statistics 6 (1979), 65–70.
/// @param chances  p of each test
std::vector<bool> refused_together(const std::vector<double>& chances, double level);

}  // namespace posewright
