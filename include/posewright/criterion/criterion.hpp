#pragma once

#include <Eigen/Dense>
#include <memory>
#include <string>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// What a criterion sees of a design problem: candidate blocks, well conditioned (see planning/whiten.hpp).
struct CandidateView {
  const BlockArray* blocks = nullptr;
  int nuisance = 0;     ///< the leading columns that are nuisance; eliminated by Schur complement
  int max_repeats = 1;  ///< how often one candidate may be chosen
  /// Information that is there before any pose is measured (m × m, positive semidefinite); null: none.
  const Eigen::MatrixXd* prior = nullptr;
};

/// One exchange: candidate `enter` takes the place of the member at a position; `gain` is Φ(after) − Φ(before).
struct Swap {
  int enter = -1;  ///< −1: nothing gains more than was asked for
  double gain = 0.0;
};

/// A design under search, under one criterion Φ (always maximised). Owns all running quantities (inverse, traces of
/// every candidate); the loops over candidates are inside, so that an algorithm is written once for every criterion.
class DesignState {
 public:
  DesignState(const CandidateView& view, std::vector<int> members);
  virtual ~DesignState() = default;

  const std::vector<int>& members() const { return members_; }
  /// Puts `enter` in the place of the member at `position` and updates every running quantity.
  void apply(int position, int enter);

  /// Φ from the running quantities; −∞ where the information is singular.
  virtual double value() const = 0;
  /// Estimate of what Φ loses without the member at `position`: the order in which positions are tried.
  virtual double loss(int position) const = 0;
  /// Best candidate for `position` with a gain above min_gain.
  virtual Swap best_swap(int position, double min_gain) = 0;
  /// Recomputes every running quantity from the blocks. Returns false where the information is singular; the
  /// state then works with a small ridge (M + εI) until a later refresh succeeds without.
  virtual bool refresh() = 0;

 protected:
  const BlockArray& blocks() const { return *view_.blocks; }
  /// One byte a candidate: 1 where the repeat policy forbids to choose it once more.
  const std::vector<unsigned char>& blocked() const { return blocked_; }

 private:
  virtual void do_apply(int leave, int enter) = 0;
  void count(int candidate, int change);

  CandidateView view_;
  std::vector<int> members_;
  std::vector<int> used_;
  std::vector<unsigned char> blocked_;
};

/// A number Φ to maximise over sets of N configurations.
class Criterion {
 public:
  virtual ~Criterion() = default;
  virtual std::string name() const = 0;
  /// A state that starts from `members` (indices into the view's blocks).
  virtual std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const = 0;
};

}  // namespace posewright
