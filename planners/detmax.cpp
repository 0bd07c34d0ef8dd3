#include "detmax.hpp"

#include <algorithm>
#include <cmath>

#include "restarts.hpp"

namespace posewright {
namespace {

// Mitchell's limit of how far an excursion goes.
constexpr int longest_excursion = 6;

bool add_best(DesignState& state) {
  const Swap best = state.best_addition();
  if (best.enter < 0) return false;
  state.add(best.enter);
  return true;
}

bool remove_least(DesignState& state) {
  int least = -1;
  double loss = -std::numeric_limits<double>::infinity();
  for (int position = 0; position < int(state.members().size()); ++position)
    if (const double change = state.removal(position); change > loss) {
      loss = change;
      least = position;
    }
  if (least < 0) return false;
  state.remove(least);
  return true;
}

/// Goes `length` poses away from N and back. Where it must turn early it comes back as far as it went.
void excursion(DesignState& state, int length, bool upwards) {
  int away = 0;
  while (away < length && (upwards ? add_best(state) : remove_least(state))) ++away;
  for (; away > 0; --away)
    if (!(upwards ? remove_least(state) : add_best(state))) break;
}

/// Back to `members` whatever the number of members is now.
void reset(DesignState& state, const std::vector<int>& members) {
  while (state.members().size() > members.size()) state.remove(int(state.members().size()) - 1);
  for (const int i : members)
    if (state.members().size() < members.size() && state.may_enter(i)) state.add(i);
  restore(state, members);
}

Outcome search(const DesignTask& task, std::vector<int> start, const Monitor& monitor) {
  const auto state = task.criterion->start(task.candidates, std::move(start));
  Outcome best = outcome_of(*state, 0);
  for (int length = 1; length <= longest_excursion && !monitor.should_stop();) {
    bool gained = false;
    for (const bool upwards : {true, false}) {
      excursion(*state, length, upwards);
      if (int(state->members().size()) == task.poses) {
        state->refresh();
        gained = state->value() > best.value + smallest_gain;
      }
      if (gained) break;
      reset(*state, best.members);
    }
    if (gained) {
      const long exchanges = best.exchanges + 1;
      best = outcome_of(*state, exchanges);
    }
    length = gained ? 1 : length + 1;
  }
  return best;
}

}  // namespace

Design DetmaxPlanner::do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const {
  return run_restarts(task, options, monitor, "detmax",
                      [](const DesignTask& part, std::size_t i, Random& random, const Monitor& watch) {
                        return search(part, raw_start(part, i, random), watch);
                      });
}

}  // namespace posewright
