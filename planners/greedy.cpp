#include <algorithm>

#include "planners.hpp"
#include "restarts.hpp"

namespace posewright {
namespace {

/// The first start has nothing to draw; of further ones, from a drawn pose each, as many as some seconds allow.
int affordable_starts(const DesignTask& task, int most) {
  constexpr double most_products = 1e9;
  return int(std::clamp(most_products / products_of_a_pass(task), 1.0, double(most)));
}

/// Adds the best candidate until there are N. The first start begins with nothing; the others with one random
/// candidate, because the first choices, made while most parameters are unknown, decide much (GRASP, Feo & Resende
/// 1995). No exchange follows: what greedy misses is what the other planners add.
Design greedy_design(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) {
  // Over all candidates: there is no pass afterwards that would bring back what a reduction left out.
  const ApproximateDesign nothing_known;
  DesignTask whole = task;
  whole.approximate = &nothing_known;
  PlannerOptions affordable = options;
  if (!options.restarts_stated) affordable.restarts = affordable_starts(task, options.restarts);
  return run_restarts(whole, affordable, monitor, "greedy",
                      [](const DesignTask& part, std::size_t i, Random& random, const Monitor&) {
                        std::vector<int> first;
                        if (i > 0) first.push_back(random.index(int(part.candidates.blocks->count())));
                        const auto state = part.criterion->start(part.candidates, first);
                        fill_greedily(*state, part.poses);
                        state->refresh();
                        return outcome_of(*state, 0);
                      });
}

}  // namespace

Planner greedy_planner() { return {"greedy", "one pose after the other, no way back", greedy_design}; }

}  // namespace posewright
