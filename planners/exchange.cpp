#include "exchange.hpp"

#include "planners.hpp"
#include "restarts.hpp"

namespace posewright {
namespace {

/// True if what is left to gain is proved to be less than any figure shows.
bool proved(const DesignTask& task, double value) {
  constexpr double most_left = 5e-5;
  return task.bound && *task.bound - value < most_left * task.criterion->function().degree();
}

}  // namespace

Outcome exchange_search(const DesignTask& task, std::vector<int> start, int kicks, Random& random,
                        const Monitor& monitor) {
  const auto state = task.criterion->start(task.candidates, std::move(start));
  const long exchanges = settle(*state, monitor);
  Outcome best = outcome_of(*state, exchanges);
  for (int i = 0; i < kicks && !proved(task, best.value) && !monitor.should_stop(); ++i) {
    kick(*state, int(task.candidates.blocks->count()), random);
    const long more = best.exchanges + settle(*state, monitor);
    if (state->value() > best.value + smallest_gain) best = outcome_of(*state, more);
    else restore(*state, best.members);
    best.exchanges = more;
  }
  return best;
}

namespace {

/// As many local optima from fresh starts as a chain of kicks has, for landscapes where chains get stuck.
Outcome fresh_starts(const DesignTask& task, std::size_t restart, int count, Random& random, const Monitor& monitor) {
  Outcome best;
  for (int i = 0; i <= count && (i == 0 || !monitor.should_stop()); ++i) {
    // The first is the restart's own; weights and uniform draws take turns after it.
    const std::size_t kind = i == 0 ? restart : std::size_t(1 + i % 4 / 3);
    Outcome found = exchange_search(task, start_of_restart(task, kind, random, monitor), 0, random, monitor);
    found.exchanges += best.exchanges;
    if (!best.done || found.value > best.value + smallest_gain) best = std::move(found);
    else best.exchanges = found.exchanges;
  }
  return best;
}

}  // namespace

Outcome exchange_restart(const DesignTask& task, std::size_t restart, int kicks, Random& random,
                         const Monitor& monitor) {
  // A start that settles under smoother criteria first takes the time of so many.
  constexpr int smooth_cost = 12;
  const int fresh = task.criterion->smoother() == nullptr ? kicks : kicks / smooth_cost;
  if (restart % 2 == 1) return fresh_starts(task, restart, fresh, random, monitor);
  return exchange_search(task, start_of_restart(task, restart, random, monitor), kicks, random, monitor);
}

namespace {

/// Best-exchange search from many starts. One pass tries every member once, the one that Φ misses least first
/// (Cook & Nachtsheim 1980), and takes its best partner at once (Fedorov 1972); passes repeat until none gains.
/// Each local optimum is then kicked:
/// a few members are replaced at random and the passes repeat, keeping what gains (iterated local search, Lourenço,
/// Martin & Stützle 2003); every other restart makes as many fresh starts instead. Starts: rounded optimal weights,
/// draws from them, and uniform draws, in turn. Restarts run in parallel; each depends on (seed, restart index) alone.
Design exchange_design(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) {
  return run_restarts(task, options, monitor, "exchange",
                      [&](const DesignTask& part, std::size_t i, Random& random, const Monitor& watch) {
                        return exchange_search(part, start_of_restart(part, i, random, watch),
                                               affordable_kicks(part, options), random, watch);
                      });
}

}  // namespace

Planner exchange_planner() {
  return {"exchange", "best exchange with rank-r updates from many starts", exchange_design};
}

}  // namespace posewright
