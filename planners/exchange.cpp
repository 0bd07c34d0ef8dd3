#include "exchange.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>

#include "posewright/support/parallel.hpp"
#include "reduced_task.hpp"
#include "starts.hpp"

namespace posewright {
namespace {

// Gains below this are rounding of the running inverse, not progress.
constexpr double smallest_gain = 1e-10;
// How many of the reduced search's results are taken through all candidates.
constexpr std::size_t finished = 3;

std::vector<int> start_of_restart(const DesignTask& task, std::size_t restart, Random& random) {
  const bool weights = task.approximate != nullptr && !task.approximate->support.empty();
  if (weights && restart == 0) return rounded_start(task);
  if (weights && restart % 2 == 1) return weighted_start(task, random);
  return uniform_start(task, random);
}

/// One pass over all positions; returns the number of accepted swaps.
int exchange_pass(DesignState& state, std::vector<int>& order) {
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> loss(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) loss[i] = state.loss(int(i));
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return loss[std::size_t(a)] < loss[std::size_t(b)]; });
  int accepted = 0;
  for (const int position : order) {
    const Swap swap = state.best_swap(position, smallest_gain);
    if (swap.enter < 0) continue;
    state.apply(position, swap.enter);
    ++accepted;
  }
  return accepted;
}

struct Outcome {
  std::vector<int> members;
  double value = -std::numeric_limits<double>::infinity();
  long exchanges = 0;
  bool done = false;
};

/// Passes until none gains; a refresh after the last one shows whether the running numbers hid a gain.
long settle(DesignState& state, const Monitor& monitor) {
  std::vector<int> order(state.members().size());
  long total = 0;
  while (true) {
    int accepted = 0, now = 0;
    do {
      now = exchange_pass(state, order);
      accepted += now;
    } while (now > 0 && !monitor.should_stop());
    state.refresh();
    total += accepted;
    if (accepted == 0 || monitor.should_stop()) return total;
  }
}

/// Replaces two to five members by random candidates.
void kick(DesignState& state, const DesignTask& task, Random& random) {
  const auto count = std::min<std::size_t>(2 + std::size_t(random.index(4)), state.members().size());
  for (std::size_t i = 0; i < count; ++i) {
    const int enter = random.index(int(task.candidates.blocks->count()));
    const auto used = std::count(state.members().begin(), state.members().end(), enter);
    if (used < task.candidates.max_repeats) state.apply(random.index(task.poses), enter);
  }
}

/// Puts the state back to `members` (as a multiset): what is missing takes the place of what is too much.
void restore(DesignState& state, const std::vector<int>& members) {
  std::vector<int> missing = members, surplus;
  for (int position = 0; position < int(members.size()); ++position) {
    const auto found = std::find(missing.begin(), missing.end(), state.members()[std::size_t(position)]);
    if (found == missing.end()) surplus.push_back(position);
    else missing.erase(found);
  }
  for (std::size_t i = 0; i < surplus.size(); ++i) state.apply(surplus[i], missing[i]);
}

Outcome outcome_of(const DesignState& state, long exchanges) {
  return {state.members(), state.value(), exchanges, true};
}

/// Local optimum, then kicks.
Outcome search(const DesignTask& task, std::vector<int> start, int kicks, Random& random, const Monitor& monitor) {
  const auto state = task.criterion->start(task.candidates, std::move(start));
  const long exchanges = settle(*state, monitor);
  Outcome best = outcome_of(*state, exchanges);
  for (int i = 0; i < kicks && !monitor.should_stop(); ++i) {
    kick(*state, task, random);
    const long more = best.exchanges + settle(*state, monitor);
    if (state->value() > best.value + smallest_gain) best = outcome_of(*state, more);
    else restore(*state, best.members);
    best.exchanges = more;
  }
  return best;
}

/// Passes over all candidates for the best few outcomes of the reduced search: the result is a local optimum of the
/// whole task. Outcomes are in the order of restarts; equal values count once.
void finish(const DesignTask& task, const ReducedTask& reduced, std::vector<Outcome>& outcomes, int threads,
            const Monitor& monitor) {
  std::vector<std::size_t> order(outcomes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return outcomes[a].value > outcomes[b].value; });
  std::vector<std::size_t> best;
  for (const std::size_t i : order)
    if (outcomes[i].done && best.size() < finished &&
        (best.empty() || outcomes[i].value < outcomes[best.back()].value - smallest_gain))
      best.push_back(i);
  std::vector<Outcome> result(best.size());
  parallel_for(best.size(), threads, [&](std::size_t i, int) {
    const Outcome& outcome = outcomes[best[i]];
    const auto state = task.criterion->start(task.candidates, reduced.original(outcome.members));
    result[i] = outcome_of(*state, outcome.exchanges + settle(*state, monitor));
  });
  for (Outcome& outcome : outcomes) outcome.value = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < best.size(); ++i) outcomes[best[i]] = result[i];
}

}  // namespace

Design ExchangePlanner::do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const {
  const ReducedTask reduced(task);
  std::vector<Outcome> outcomes(std::size_t(options.restarts));
  std::mutex mutex;
  const int interest = task.candidates.blocks->columns() - task.candidates.nuisance;
  Progress progress{"exchange", 0, double(options.restarts), {}, {}, {}};
  progress.bound = task.bound;
  parallel_for(outcomes.size(), thread_count(options.threads), [&](std::size_t i, int) {
    // The first restart always runs: whoever interrupts still gets a plan.
    if (i > 0 && monitor.should_stop()) return;
    Random random(options.seed, i);
    outcomes[i] = search(reduced.task(), start_of_restart(reduced.task(), i, random), options.kicks, random, monitor);
    const std::scoped_lock lock(mutex);
    progress.done += 1;
    progress.best = std::max(progress.best.value_or(outcomes[i].value), outcomes[i].value);
    if (progress.bound) progress.efficiency = std::exp((*progress.best - *progress.bound) / interest);
    monitor.report(progress);
  });
  if (reduced.is_smaller()) finish(task, reduced, outcomes, thread_count(options.threads), monitor);

  Design design;
  design.value = -std::numeric_limits<double>::infinity();
  for (const Outcome& outcome : outcomes) {
    if (!outcome.done) continue;
    design.restarts += 1;
    design.exchanges += outcome.exchanges;
    if (design.members.empty() || outcome.value > design.value) {
      design.value = outcome.value;
      design.members = outcome.members;
    }
  }
  design.stopped = monitor.should_stop() && design.restarts < options.restarts;
  return design;
}

}  // namespace posewright
