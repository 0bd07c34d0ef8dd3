#include "mixed_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "by_bound.hpp"
#include "posewright/criterion/leave_one_out.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

/// The columns of one variant and those of the rows that are not zero in them.
BlockArray own_blocks(const BlockArray& blocks, const VariantGroup& group) {
  int first = blocks.rows(), last = -1;
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    const auto own = blocks.block(i).middleCols(group.first, group.columns);
    for (int row = 0; row < blocks.rows(); ++row) {
      if (row >= first && row <= last) continue;
      if ((own.row(row).array() == 0).all()) continue;
      first = std::min(first, row);
      last = std::max(last, row);
    }
  }
  const int rows = std::max(1, last - first + 1);
  if (last < 0) first = 0;
  BlockArray result(blocks.count(), rows, group.columns);
  for (std::size_t i = 0; i < blocks.count(); ++i)
    result.block(i) = blocks.block(i).block(first, group.first, rows, group.columns);
  return result;
}

/// One variant: its determinants by rank-r changes of what remains without the leaving member.
class Share {
 public:
  Share(const CandidateView& view, const VariantGroup& group)
      : group_(group), interest_(group.columns - group.nuisance), blocks_(own_blocks(*view.blocks, group)) {
    if (view.prior != nullptr) prior_ = view.prior->block(group.first, group.first, group.columns, group.columns);
    rest_ = std::make_unique<LeaveOneOut>(blocks_, group.nuisance, view.prior != nullptr ? &prior_ : nullptr);
  }
  Share(const Share&) = delete;
  Share& operator=(const Share&) = delete;

  double weight() const { return group_.weight; }
  void set_members(const std::vector<int>& members) { rest_->set_members(members); }
  void exchange(int leave, int enter) { rest_->exchange(leave, enter); }
  void leave(int k) { rest_->leave(k); }

  /// ln e_v; −∞ where singular.
  double efficiency() const { return of(rest_->value()); }
  /// The same with the ridge of a singular design: what gains count from.
  double reference() const { return of(rest_->reference()); }
  /// ∂ ln e_v per unit of weight on candidate j.
  double sensitivity(int j) const { return rest_->sensitivities()[std::size_t(j)] / interest_; }
  /// No less than gain(j): Φ is concave, and no swap gains more than adding alone.
  double most(int j, int leaving) const {
    const std::vector<double>& all = rest_->sensitivities();
    const double d = all[std::size_t(j)], r = blocks_.rows();
    return std::min(d - (leaving < 0 ? 0.0 : all[std::size_t(leaving)]), r * std::log1p(d / r)) / interest_;
  }
  double gain(int j) { return rest_->gain(j) / interest_; }
  /// ln e_v with j in the place of k, from scratch.
  double exact(int k, int j) const { return of(rest_->exact(k, j)); }

 private:
  double of(double log_det) const { return (log_det - group_.reference) / interest_; }

  VariantGroup group_;
  double interest_;
  BlockArray blocks_;
  Eigen::MatrixXd prior_;
  std::unique_ptr<LeaveOneOut> rest_;
};

/// A swap changes each ln e_v by its own determinant formula (LeaveOneOut). Candidates come by what they gain at most,
/// and each is dropped as soon as the variants looked at, with the bounds of the others, cannot beat the best.
class MixedState : public DesignState {
 public:
  MixedState(const CandidateView& view, std::vector<int> members, const std::vector<VariantGroup>& variants,
             bool minimum)
      : DesignState(view, std::move(members)), minimum_(minimum) {
    for (const VariantGroup& group : variants) shares_.push_back(std::make_unique<Share>(view, group));
    gains_.resize(shares_.size());
    refresh();
  }

  double value() const override {
    return mixed([](const Share& share) { return share.efficiency(); });
  }

  double loss(int position) const override {
    const int k = members()[std::size_t(position)];
    double sum = 0.0;
    for (const auto& share : shares_) sum += share->weight() * share->sensitivity(k);
    return minimum_ ? shares_[worst()]->sensitivity(k) : sum;
  }

  Swap best_addition() override { return best_of(-1, -infinity); }

  double removal(int position) override {
    const int k = members()[std::size_t(position)];
    return mixed([&](const Share& share) { return share.exact(k, -1); }) - value();
  }

  bool refresh() override {
    for (const auto& share : shares_) share->set_members(members());
    return std::isfinite(value());
  }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    const int k = members()[std::size_t(position)];
    const Swap best = best_of(k, min_gain);
    if (best.enter < 0 || !std::isfinite(value())) return best;
    // Where a member was indispensable the gain rests on a ridge; only the exact one counts.
    const double gain = mixed([&](const Share& share) { return share.exact(k, best.enter); }) - value();
    return gain > min_gain ? Swap{best.enter, gain} : Swap{};
  }

  void do_change(int leave, int enter) override {
    for (const auto& share : shares_) share->exchange(leave, enter);
  }

  template <class Of>
  double mixed(const Of& of) const {
    double sum = 0.0, least = infinity;
    for (const auto& share : shares_) {
      const double each = of(*share);
      sum += share->weight() * each;
      least = std::min(least, each);
    }
    return minimum_ ? least : sum;
  }

  std::size_t worst() const {
    std::size_t least = 0;
    for (std::size_t v = 1; v < shares_.size(); ++v)
      if (shares_[v]->reference() < shares_[least]->reference()) least = v;
    return least;
  }

  /// Φ less `now` where each ln e_v has grown by gains_[v].
  double mixed_gain(double now) const {
    double sum = 0.0, least = infinity;
    for (std::size_t v = 0; v < shares_.size(); ++v) {
      sum += shares_[v]->weight() * gains_[v];
      if (minimum_) least = std::min(least, shares_[v]->reference() + gains_[v]);
    }
    return minimum_ ? least - now : sum;
  }

  double most(int j, int leaving, double now) {
    for (std::size_t v = 0; v < shares_.size(); ++v) gains_[v] = shares_[v]->most(j, leaving);
    return mixed_gain(now);
  }

  Swap best_of(int leaving, double min_gain) {
    const double now = mixed([](const Share& share) { return share.reference(); });
    queue_.clear();
    for (int j = 0; j < int(blocks().count()); ++j) {
      if (blocked()[std::size_t(j)] != 0) continue;
      const double bound = most(j, leaving, now);
      if (bound > min_gain) queue_.add(bound, j);
    }
    Swap best{-1, min_gain};
    if (queue_.empty()) return {};
    queue_.order();
    for (const auto& share : shares_) share->leave(leaving);
    // The variant that the plan serves worst decides most.
    const std::size_t first = worst();
    while (!queue_.empty()) {
      const auto [bound, j] = queue_.next();
      if (bound <= best.gain) break;
      most(j, leaving, now);
      double gain = bound;
      for (std::size_t i = 0; i < shares_.size() && gain > best.gain; ++i) {
        const std::size_t v = i == 0 ? first : i <= first ? i - 1 : i;
        gains_[v] = shares_[v]->gain(j);
        gain = mixed_gain(now);
      }
      if (gain > best.gain) best = {j, gain};
    }
    return best.enter < 0 ? Swap{} : best;
  }

  bool minimum_;
  std::vector<std::unique_ptr<Share>> shares_;
  std::vector<double> gains_;
  ByBound queue_;
};

}  // namespace

std::unique_ptr<DesignState> start_mixed(const CandidateView& view, std::vector<int> members,
                                         const std::vector<VariantGroup>& variants, bool minimum) {
  return std::make_unique<MixedState>(view, std::move(members), variants, minimum);
}

}  // namespace posewright
