#include "exchange.hpp"

#include "restarts.hpp"

namespace posewright {

Outcome exchange_search(const DesignTask& task, std::vector<int> start, int kicks, Random& random,
                        const Monitor& monitor) {
  const auto state = task.criterion->start(task.candidates, std::move(start));
  const long exchanges = settle(*state, monitor);
  Outcome best = outcome_of(*state, exchanges);
  for (int i = 0; i < kicks && !monitor.should_stop(); ++i) {
    kick(*state, int(task.candidates.blocks->count()), random);
    const long more = best.exchanges + settle(*state, monitor);
    if (state->value() > best.value + smallest_gain) best = outcome_of(*state, more);
    else restore(*state, best.members);
    best.exchanges = more;
  }
  return best;
}

Design ExchangePlanner::do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const {
  return run_restarts(task, options, monitor, "exchange",
                      [&](const DesignTask& part, std::size_t i, Random& random, const Monitor& watch) {
                        return exchange_search(part, start_of_restart(part, i, random), options.kicks, random, watch);
                      });
}

}  // namespace posewright
