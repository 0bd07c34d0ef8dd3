#include "local_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr int most_singular_passes = 50;

/// Passes over all positions of a design. A position that had no swap is asked again only after another was swapped:
/// before that it would be told the same.
class Passes {
 public:
  explicit Passes(DesignState& state)
      : state_(state), order_(state.members().size()), loss_(order_.size()), without_swap_(order_.size(), never) {}

  /// Number of accepted swaps. The first pass of a start is a whole one, so that whoever stops early still gets a plan.
  int next(const Monitor& monitor) {
    std::iota(order_.begin(), order_.end(), 0);
    for (std::size_t i = 0; i < order_.size(); ++i) loss_[i] = state_.loss(int(i));
    std::stable_sort(order_.begin(), order_.end(),
                     [&](int a, int b) { return loss_[std::size_t(a)] < loss_[std::size_t(b)]; });
    const long before = swaps_;
    for (const int position : order_) {
      if (!first_ && monitor.should_stop()) break;
      try_at(position);
    }
    first_ = false;
    return int(swaps_ - before);
  }

  /// Every position is asked again: the state's numbers are others.
  void forget() { std::fill(without_swap_.begin(), without_swap_.end(), never); }

 private:
  static constexpr long never = -1;

  void try_at(int position) {
    long& asked = without_swap_[std::size_t(position)];
    if (asked == swaps_) return;
    const Swap swap = state_.best_swap(position, smallest_gain);
    if (swap.enter < 0) {
      asked = swaps_;
      return;
    }
    state_.apply(position, swap.enter);
    ++swaps_;
  }

  DesignState& state_;
  std::vector<int> order_;
  std::vector<double> loss_;
  std::vector<long> without_swap_;  // of each position: swaps before it was last asked in vain
  long swaps_ = 0;
  bool first_ = true;
};

}  // namespace

Outcome outcome_of(const DesignState& state, long exchanges) {
  return {state.members(), state.value(), exchanges, true};
}

long settle(DesignState& state, const Monitor& monitor) {
  Passes passes(state);
  long total = 0;
  int singular = 0;
  while (true) {
    int accepted = 0, now = 0;
    do {
      now = passes.next(monitor);
      accepted += now;
      // Gains of a singular set are those of M plus a ridge; if no set is regular they may go round for ever.
      if (!std::isfinite(state.value()) && ++singular >= most_singular_passes) break;
    } while (now > 0 && !monitor.should_stop());
    const double running = state.value();
    state.refresh();
    total += accepted;
    if (accepted == 0 || singular >= most_singular_passes || monitor.should_stop()) return total;
    if (std::abs(state.value() - running) <= smallest_gain) return total;
    passes.forget();
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
