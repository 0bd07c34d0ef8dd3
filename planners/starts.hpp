#pragma once

#include <vector>

#include "posewright/planning/design_task.hpp"
#include "posewright/support/random.hpp"

namespace posewright {

/// The N candidates with the largest N·w, the multiplicity N·w rounded down first if repeats are allowed.
std::vector<int> rounded_start(const DesignTask& task);
/// N draws from the optimal weights without exceeding the repeat policy; filled up uniformly where the support is
/// small.
std::vector<int> weighted_start(const DesignTask& task, Random& random);
/// N uniform draws within the repeat policy.
std::vector<int> uniform_start(const DesignTask& task, Random& random);

}  // namespace posewright
