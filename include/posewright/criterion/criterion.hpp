#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/spacing.hpp"

namespace posewright {

class InformationFunction;

/// Data of a design problem for criteria: candidate blocks, well conditioned (see planning/whiten.hpp).
struct CandidateView {
  const BlockArray* blocks = nullptr;
  int nuisance = 0;     ///< the leading columns that are nuisance; eliminated by Schur complement
  int max_repeats = 1;  ///< how often one candidate may be chosen
  /// Information that is there before any pose is measured (m × m, positive semidefinite); null: none.
  const Eigen::MatrixXd* prior = nullptr;
  const Spacing* spacing = nullptr;  ///< which candidates may not be chosen together; null: all may
};

/// A change of a design: candidate `enter` comes in (in place of the member at a position, or as one more); `gain` is
/// Φ(after) − Φ(before).
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
  /// One member more, at the last position; one member less, the last takes its position.
  void add(int enter);
  void remove(int position);

  /// Φ from the running quantities; −∞ where the information is singular.
  virtual double value() const = 0;
  /// Estimated loss of Φ without the member at `position`: the order in which positions are tried.
  virtual double loss(int position) const = 0;
  /// Best candidate for `position` with a gain above min_gain; never the member that is there.
  Swap best_swap(int position, double min_gain);
  /// Best candidate to add. Where the information is singular the gain is that of M plus a ridge.
  virtual Swap best_addition() = 0;
  /// Φ without the member at `position` less Φ now, exact; −∞ where it is indispensable.
  virtual double removal(int position) = 0;
  /// Recomputes every running quantity from the blocks. Returns false if the information is singular; the
  /// state then works with a small ridge (M + εI) until a later refresh succeeds without.
  virtual bool refresh() = 0;

  /// A banned candidate may not enter.
  void ban(int candidate, bool banned);
  /// True if the candidate may enter now under the repeat policy, the spacing with its limits, and the bans.
  bool may_enter(int candidate) const { return blocked_[std::size_t(candidate)] == 0; }
  /// True if it may enter in the place of the member at `position`, which leaves its part of a limit.
  bool may_replace(int position, int candidate) const;

 protected:
  const BlockArray& blocks() const { return *view_.blocks; }
  const CandidateView& view() const { return view_; }
  /// One byte a candidate: not 0 where it may not enter.
  const std::vector<unsigned char>& blocked() const { return blocked_; }

 private:
  virtual Swap do_best_swap(int position, double min_gain) = 0;
  /// `leave` or `enter` is −1 where nothing leaves or enters; members() are those after the change.
  virtual void do_change(int leave, int enter) = 0;
  void count(int candidate, int change);
  void count_limit(int candidate, int change);
  /// @param left  further members that the limit of the candidate's value allows
  bool is_blocked(int candidate, int left) const;
  int left_for(int candidate) const;
  void judge(int candidate);

  CandidateView view_;
  std::vector<int> members_;
  std::vector<int> used_, crowd_;
  std::vector<int> free_;  // per value of the coordinate that the spacing limits: how many more may enter
  std::vector<unsigned char> banned_, blocked_;
};

/// A number Φ to maximise over sets of N configurations.
class Criterion {
 public:
  virtual ~Criterion() = default;
  virtual std::string name() const = 0;
  /// Φ as a function of the information alone.
  virtual const InformationFunction& function() const = 0;
  /// True if Φ of a design is function() of its information: false if losses of single poses count too.
  virtual bool of_information_alone() const { return true; }
  /// A state that starts from `members` (indices into the view's blocks), maybe none.
  virtual std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const = 0;
  /// A smoother criterion, maybe with a smoother one of its own, whose local optimum is the better start: where Φ has
  /// kinks, hardly any swap of one member gains. Null: none.
  virtual const Criterion* smoother() const { return nullptr; }
};

}  // namespace posewright
