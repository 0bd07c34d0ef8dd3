#include "local_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr int most_singular_passes = 50;

/// One pass over all positions; returns the number of accepted swaps. The first pass of a start is a whole one, so that
/// whoever stops early still gets a plan.
int exchange_pass(DesignState& state, std::vector<int>& order, bool whole, const Monitor& monitor) {
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> loss(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) loss[i] = state.loss(int(i));
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return loss[std::size_t(a)] < loss[std::size_t(b)]; });
  int accepted = 0;
  for (const int position : order) {
    if (!whole && monitor.should_stop()) break;
    const Swap swap = state.best_swap(position, smallest_gain);
    if (swap.enter < 0) continue;
    state.apply(position, swap.enter);
    ++accepted;
  }
  return accepted;
}

}  // namespace

Outcome outcome_of(const DesignState& state, long exchanges) {
  return {state.members(), state.value(), exchanges, true};
}

long settle(DesignState& state, const Monitor& monitor) {
  std::vector<int> order(state.members().size());
  long total = 0;
  int singular = 0, passes = 0;
  while (true) {
    int accepted = 0, now = 0;
    do {
      now = exchange_pass(state, order, passes++ == 0, monitor);
      accepted += now;
      // Gains of a singular set are those of M plus a ridge; if no set is regular they may go round for ever.
      if (!std::isfinite(state.value()) && ++singular >= most_singular_passes) break;
    } while (now > 0 && !monitor.should_stop());
    state.refresh();
    total += accepted;
    if (accepted == 0 || singular >= most_singular_passes || monitor.should_stop()) return total;
  }
}

void kick(DesignState& state, int candidates, Random& random) {
  // Measured on the instances of docs/benchmarks.md: kicks of two to five fall back to where they came from.
  const auto half = std::max<std::size_t>(2, state.members().size() / 2);
  const auto count = std::min({std::size_t(6 + random.index(8)), half, state.members().size()});
  for (std::size_t i = 0; i < count; ++i) {
    const int enter = random.index(candidates), position = random.index(int(state.members().size()));
    if (state.may_replace(position, enter)) state.apply(position, enter);
  }
}

void restore(DesignState& state, const std::vector<int>& members) {
  std::vector<int> missing = members, surplus;
  for (int position = 0; position < int(state.members().size()); ++position) {
    const auto found = std::find(missing.begin(), missing.end(), state.members()[std::size_t(position)]);
    if (found == missing.end()) surplus.push_back(position);
    else missing.erase(found);
  }
  for (std::size_t i = 0; i < surplus.size(); ++i) state.apply(surplus[i], missing[i]);
}

void fill_greedily(DesignState& state, int poses) {
  while (int(state.members().size()) < poses) {
    const Swap best = state.best_addition();
    if (best.enter < 0)
      throw CannotDo("the candidates do not suffice for " + std::to_string(poses) +
                     " poses at the minimum distance and within the limits: only " +
                     std::to_string(state.members().size()) + " fit");
    state.add(best.enter);
  }
}

}  // namespace posewright
