#pragma once

#include "local_search.hpp"

namespace posewright {

/// Swaps without a new best after which a start ends, where `exchange` would have made so many kicks.
int tabu_patience(const DesignTask& task, const PlannerOptions& options);

/// Overload from a given design.
Outcome tabu_search(const DesignTask& task, std::vector<int> start, int idle, Random& random, const Monitor& monitor);

}  // namespace posewright
