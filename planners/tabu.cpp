#include "tabu.hpp"

#include <algorithm>
#include <map>

#include "planners.hpp"
#include "restarts.hpp"

namespace posewright {
namespace {

// Swaps after which running quantities are computed anew.
constexpr long refresh_after = 40;

/// Forbidden moves and their ends.
class Memory {
 public:
  Memory(DesignState& state, int poses) : state_(state), poses_(poses) {}

  /// Forbids the reverse of recent moves for a while.
  void record(int left, int entered, long now, Random& random) {
    const int shortest = std::max(1, poses_ / 4), spread = std::max(2, poses_ / 2);
    left_until_[left] = now + shortest + random.index(spread);
    state_.ban(left, true);
    // Members are fewer than candidates: a long hold would leave nothing to move.
    held_until_[entered] = now + 1 + random.index(std::max(1, poses_ / 3));
  }
  void release(long now) {
    for (auto it = left_until_.begin(); it != left_until_.end();)
      if (it->second <= now) {
        state_.ban(it->first, false);
        it = left_until_.erase(it);
      } else {
        ++it;
      }
    std::erase_if(held_until_, [&](const auto& entry) { return entry.second <= now; });
  }
  bool is_held(int member) const { return held_until_.contains(member); }
  void lift(bool lifted) {
    for (const auto& entry : left_until_) state_.ban(entry.first, !lifted);
  }

 private:
  DesignState& state_;
  int poses_;
  std::map<int, long> left_until_, held_until_;
};

struct Move {
  int position = -1;
  Swap swap;
};

/// Best swap over the positions that `among` allows, with a gain above min_gain.
template <class Among>
Move best_move(DesignState& state, double min_gain, const Among& among) {
  Move best;
  best.swap.gain = min_gain;
  for (int position = 0; position < int(state.members().size()); ++position) {
    if (!among(state.members()[std::size_t(position)])) continue;
    const Swap swap = state.best_swap(position, best.swap.gain);
    if (swap.enter >= 0) best = {position, swap};
  }
  return best;
}

}  // namespace

int tabu_patience(const DesignTask& task, const PlannerOptions& options) {
  const int kicks = affordable_kicks(task, options);
  return kicks > 10 || kicks < options.kicks ? 2 * kicks : 20;
}

Outcome tabu_search(const DesignTask& task, std::vector<int> start, int idle, Random& random, const Monitor& monitor) {
  const auto state = task.criterion->start(task.candidates, std::move(start));
  long exchanges = settle(*state, monitor);
  Outcome best = outcome_of(*state, exchanges);
  Memory memory(*state, task.poses);
  long last_gain = 0;
  for (long now = 1; now - last_gain <= idle && !monitor.should_stop(); ++now) {
    memory.release(now);
    Move move = best_move(*state, -std::numeric_limits<double>::infinity(),
                          [&](int member) { return !memory.is_held(member); });
    // Aspiration: a forbidden swap to the best design ever seen.
    memory.lift(true);
    const double wanted = std::max(best.value - state->value() + smallest_gain,
                                   move.position >= 0 ? move.swap.gain : -std::numeric_limits<double>::infinity());
    const Move forbidden = best_move(*state, wanted, [](int) { return true; });
    memory.lift(false);
    if (forbidden.position >= 0) move = forbidden;
    if (move.position < 0) break;
    const int left = state->members()[std::size_t(move.position)];
    state->apply(move.position, move.swap.enter);
    memory.record(left, move.swap.enter, now, random);
    ++exchanges;
    if (now % refresh_after == 0) state->refresh();
    if (state->value() > best.value + smallest_gain) {
      best = outcome_of(*state, exchanges);
      last_gain = now;
    }
  }
  memory.release(std::numeric_limits<long>::max());
  restore(*state, best.members);
  state->refresh();
  exchanges += settle(*state, monitor);
  return outcome_of(*state, exchanges);
}

namespace {

/// Tabu search (Glover 1989, ORSA J. Computing 1(3)) over the swaps that `exchange` looks at: the best swap is taken
/// even if it loses; who left may not come back and who entered may not leave for a while (the tenure, drawn anew each
/// time), unless that gives the best design ever seen (aspiration). Ends after `idle` swaps without a new best. Starts
/// as `exchange`, each from its local optimum.
Design tabu_design(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) {
  return run_restarts(
      task, options, monitor, "tabu", [&](const DesignTask& part, std::size_t i, Random& random, const Monitor& watch) {
        return tabu_search(part, start_of_restart(part, i, random, watch), tabu_patience(part, options), random, watch);
      });
}

}  // namespace

Planner tabu_planner() { return {"tabu", "the same neighbourhood, going on where exchange stops", tabu_design}; }

}  // namespace posewright
