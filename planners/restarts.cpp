#include "restarts.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include "posewright/support/parallel.hpp"
#include "reduced_task.hpp"
#include "starts.hpp"

namespace posewright {
namespace {

// How many of the reduced search's results are taken through all candidates.
constexpr std::size_t finished = 3;

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
    const long more = settle(*state, monitor);
    result[i] = outcome_of(*state, outcome.exchanges + more);
  });
  for (Outcome& outcome : outcomes) outcome.value = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < best.size(); ++i) outcomes[best[i]] = result[i];
}

}  // namespace

std::vector<int> start_of_restart(const DesignTask& task, std::size_t index, Random& random) {
  const bool weights = task.approximate != nullptr && !task.approximate->support.empty();
  if (weights && index == 0) return rounded_start(task);
  if (weights && index % 2 == 1) return weighted_start(task, random);
  return uniform_start(task, random);
}

Design run_restarts(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor,
                    const std::string& stage, const Search& search) {
  const ReducedTask reduced(task);
  std::vector<Outcome> outcomes(std::size_t(options.restarts));
  std::mutex mutex;
  const double degree = task.criterion->function().degree();
  Progress progress{stage, 0, double(options.restarts), {}, task.bound, {}};
  parallel_for(outcomes.size(), thread_count(options.threads), [&](std::size_t i, int) {
    if (i > 0 && monitor.should_stop()) return;
    Random random(options.seed, i);
    outcomes[i] = search(reduced.task(), i, random, monitor);
    const std::scoped_lock lock(mutex);
    progress.done += 1;
    progress.best = std::max(progress.best.value_or(outcomes[i].value), outcomes[i].value);
    if (progress.bound && degree > 0) progress.efficiency = std::exp((*progress.best - *progress.bound) / degree);
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
