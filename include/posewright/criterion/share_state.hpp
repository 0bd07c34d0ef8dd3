#pragma once

#include <memory>

#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/criterion.hpp"

namespace posewright {

/// A design under search, Φ = log det M, over candidates of which this process holds a share. The design's own blocks
/// are on every process, so all of them have the same M⁻¹, and each looks for the best among its candidates: a
/// candidate's gain depends on its own block and M⁻¹ alone, never on which others are looked at. (A running search
/// passes over candidates whose bound is below the best so far; here it must be below by more than any rounding.)
class ShareState {
 public:
  /// @param blocks   whitened: `own` candidates, then `poses` + 1 blocks that the state writes; outlives it
  /// @param threads  ≥ 1; results do not depend on it
  ShareState(BlockArray& blocks, std::size_t own, int poses, int threads);
  ~ShareState();
  ShareState(const ShareState&) = delete;
  ShareState& operator=(const ShareState&) = delete;

  int size() const;
  /// −∞ where M is singular.
  double value() const;
  /// Approximate loss of Φ without the member at a position.
  double loss(int position) const;
  /// The member at a position: r rows of the blocks' stride.
  const double* member(int position) const;

  /// Best candidate of the share to come in, ties by index: one more (where M is singular the gain is that of M plus a
  /// ridge), or in place of a member with a gain above `min_gain`.
  Swap best_addition();
  Swap best_swap(int position, double min_gain);
  /// A candidate of the share that may not come in, or may again.
  void block(int candidate, bool blocked);

  /// A block comes in, which the caller has from the process that holds it: as the last member, or for another.
  void add(const double* entering);
  /// As add(), but nothing is known of the design then until refresh(): for a start of several.
  void put(const double* entering);
  void replace(int position, const double* entering);
  /// All running numbers afresh. False where M is singular.
  bool refresh();

 private:
  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace posewright
