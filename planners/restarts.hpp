#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "local_search.hpp"

namespace posewright {

/// One start: from (task, index, its own generator) to an outcome.
using Search = std::function<Outcome(const DesignTask&, std::size_t, Random&, const Monitor&)>;

/// Runs `restarts` starts in parallel on the promising candidates (ReducedTask), takes the best few through all
/// candidates, returns the best. Start i depends on (seed, i) alone, results are reduced by (value, index): the number
/// of threads does not matter. The first start always runs: whoever interrupts still gets a plan.
Design run_restarts(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor,
                    const std::string& stage, const Search& search);

/// Products of one pass over all candidates for every pose: the work that limits are counted in, not timed, so that a
/// plan is the same on any machine.
double products_of_a_pass(const DesignTask& task);

/// Kicks of a restart that so many candidates, poses and parameters leave time for, at most `kicks`: the usual number
/// of restarts makes some 10¹⁰ products of scanning for swaps.
int affordable_kicks(const DesignTask& task, const PlannerOptions& options);

/// Start i: rounded optimal weights, draws from them, uniform draws, in turn.
std::vector<int> raw_start(const DesignTask& task, std::size_t index, Random& random);
/// Variant settled under the smoother criteria of
/// the task's, if it has any, the smoothest first.
std::vector<int> start_of_restart(const DesignTask& task, std::size_t index, Random& random, const Monitor& monitor);

}  // namespace posewright
