#pragma once

#include <limits>
#include <tuple>
#include <vector>

#include "posewright/planning/design_task.hpp"
#include "posewright/support/random.hpp"

namespace posewright {

/// Gains below this are rounding of the running inverse, not progress.
inline constexpr double smallest_gain = 1e-10;

/// Result of one start of a search.
struct Outcome {
  std::vector<int> members;
  double value = -std::numeric_limits<double>::infinity();
  long exchanges = 0;
  bool done = false;

  static auto fields(auto& own) { return std::tie(own.members, own.value, own.exchanges, own.done); }
};
Outcome outcome_of(const DesignState& state, long exchanges);

/// Best-exchange passes until no member has a swap that gains, then a refresh; where that changes Φ, another look,
/// since running numbers may hide a gain. One pass tries members once, the one that Φ misses least first (Cook &
/// Nachtsheim 1980), and takes its best partner at once (Fedorov 1972). Returns the number of accepted swaps.
long settle(DesignState& state, const Monitor& monitor);

/// Replaces six to thirteen members, at most half of them, by random candidates that may enter.
void kick(DesignState& state, int candidates, Random& random);

/// Puts the state back to `members` (as a multiset): what is missing takes the place of what is too much.
void restore(DesignState& state, const std::vector<int>& members);

/// Adds the best candidate until the design has `poses` members. Throws CannotDo if no candidate may enter.
void fill_greedily(DesignState& state, int poses);

}  // namespace posewright
