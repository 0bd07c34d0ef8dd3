#include "greedy.hpp"

#include "restarts.hpp"

namespace posewright {

Design GreedyPlanner::do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const {
  // Over all candidates: there is no pass afterwards that would bring back what a reduction left out.
  DesignTask whole = task;
  whole.approximate = nullptr;
  return run_restarts(whole, options, monitor, "greedy",
                      [](const DesignTask& part, std::size_t i, Random& random, const Monitor&) {
                        std::vector<int> first;
                        if (i > 0) first.push_back(random.index(int(part.candidates.blocks->count())));
                        const auto state = part.criterion->start(part.candidates, first);
                        fill_greedily(*state, part.poses);
                        state->refresh();
                        return outcome_of(*state, 0);
                      });
}

}  // namespace posewright
