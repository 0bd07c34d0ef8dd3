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

/// One variant or scenario: its determinants by rank-r changes of what remains without the leaving member.
class Share {
 public:
  explicit Share(const Scenario& scenario)
      : scenario_(scenario),
        interest_(scenario.blocks->columns() - scenario.nuisance),
        rest_(*scenario_.blocks, scenario_.nuisance, scenario_.prior.size() > 0 ? &scenario_.prior : nullptr) {}
  Share(const Share&) = delete;
  Share& operator=(const Share&) = delete;

  double weight() const { return scenario_.weight; }
  void set_members(const std::vector<int>& members) { rest_.set_members(members); }
  void exchange(int leave, int enter) { rest_.exchange(leave, enter); }
  void leave(int k) { rest_.leave(k); }

  /// ln e_v; −∞ where singular.
  double efficiency() const { return of(rest_.value()); }
  /// Variant with the ridge of a singular design, the reference of gains.
  double reference() const { return of(rest_.reference()); }
  /// ∂ ln e_v per unit of weight on candidate j.
  double sensitivity(int j) const { return rest_.sensitivity(j) / interest_; }
  /// No less than gain(j) for a leaving member of sensitivity `leaving`: Φ is concave, and no swap gains more than
  /// adding alone.
  double most(int j, double leaving) const {
    const double d = rest_.sensitivity_bounds()[std::size_t(j)], r = scenario_.blocks->rows();
    return std::min(d / interest_ - leaving, r * std::log1p(d / r) / interest_);
  }
  double gain(int j) const { return rest_.gain(j) / interest_; }
  double gain_bound(int j) const { return rest_.gain_bound(j) / interest_; }
  /// ln e_v with j in the place of k, from scratch.
  double exact(int k, int j) const { return of(rest_.exact(k, j)); }

 private:
  double of(double log_det) const { return (log_det - scenario_.reference) / interest_; }

  const Scenario scenario_;
  double interest_;
  LeaveOneOut rest_;
};

RobustAim aim_of(bool minimum) { return {minimum ? RobustAim::Measure::worst : RobustAim::Measure::mean}; }

std::vector<double> weights_of(const std::vector<Scenario>& scenarios) {
  std::vector<double> weights;
  weights.reserve(scenarios.size());
  for (const Scenario& scenario : scenarios) weights.push_back(scenario.weight);
  return weights;
}

/// A swap changes each ln e_v by its own determinant formula (LeaveOneOut). Candidates come by what they gain at most,
/// and each is dropped as soon as the shares looked at, with the bounds of the others, cannot beat the best: Φ grows
/// with each of them.
class MixedState : public DesignState {
 public:
  MixedState(const CandidateView& view, std::vector<int> members, const std::vector<Scenario>& scenarios,
             const RobustAim& aim, double whole)
      : DesignState(view, std::move(members)),
        combination_(aim, weights_of(scenarios), whole),
        aim_(aim),
        now_(scenarios.size()),
        leaving_(scenarios.size()),
        then_(scenarios.size()) {
    for (const Scenario& scenario : scenarios) shares_.push_back(std::make_unique<Share>(scenario));
    refresh();
  }

  double value() const override {
    return mixed([](const Share& share) { return share.efficiency(); });
  }

  double loss(int position) const override {
    const int k = members()[std::size_t(position)];
    if (aim_.measure == RobustAim::Measure::worst) return shares_[worst()]->sensitivity(k);
    double sum = 0.0;
    for (const auto& share : shares_) sum += share->weight() * share->sensitivity(k);
    return sum;
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
    for (std::size_t v = 0; v < shares_.size(); ++v) then_[v] = of(*shares_[v]);
    return combination_.of(then_);
  }

  std::size_t worst() const {
    std::size_t least = 0;
    for (std::size_t v = 1; v < shares_.size(); ++v)
      if (shares_[v]->reference() < shares_[least]->reference()) least = v;
    return least;
  }

  /// Φ at most after j enters, less Φ now; then_ holds the parts.
  double most(int j, double now) {
    for (std::size_t v = 0; v < shares_.size(); ++v) then_[v] = now_[v] + shares_[v]->most(j, leaving_[v]);
    return combination_.of(then_) - now;
  }

  /// Exact gain, or what is no more than `least` as soon as that is certain.
  double gain(int j, double now, std::size_t first, double least) {
    double gain = most(j, now);
    for (const bool exact : {false, true})
      for (std::size_t i = 0; i < shares_.size() && gain > least; ++i) {
        const std::size_t v = i == 0 ? first : i <= first ? i - 1 : i;
        const double own = now_[v] + (exact ? shares_[v]->gain(j) : shares_[v]->gain_bound(j));
        if (aim_.measure == RobustAim::Measure::mean) gain += combination_.supporting(then_)[v] * (own - then_[v]);
        then_[v] = own;
        if (aim_.measure != RobustAim::Measure::mean) gain = combination_.of(then_) - now;
      }
    return gain;
  }

  Swap best_of(int leaving, double min_gain) {
    for (std::size_t v = 0; v < shares_.size(); ++v) {
      now_[v] = shares_[v]->reference();
      leaving_[v] = leaving < 0 ? 0.0 : shares_[v]->sensitivity(leaving);
    }
    const double now = combination_.of(now_);
    queue_.clear();
    for (int j = 0; j < int(blocks().count()); ++j) {
      if (blocked()[std::size_t(j)] != 0) continue;
      const double bound = most(j, now);
      if (bound > min_gain) queue_.add(bound, j);
    }
    Swap best{-1, min_gain};
    if (queue_.empty()) return {};
    queue_.order();
    for (const auto& share : shares_) share->leave(leaving);
    // The one that the plan serves worst decides most.
    const std::size_t first = worst();
    while (!queue_.empty()) {
      const auto [bound, j] = queue_.next();
      if (bound <= best.gain) break;
      const double found = gain(j, now, first, best.gain);
      if (found > best.gain) best = {j, found};
    }
    return best.enter < 0 ? Swap{} : best;
  }

  mutable Combination combination_;
  RobustAim aim_;
  std::vector<std::unique_ptr<Share>> shares_;
  std::vector<double> now_, leaving_;  ///< ln e_v of each share, and its sensitivity to the leaving member
  mutable std::vector<double> then_;
  ByBound queue_;
};

}  // namespace

std::unique_ptr<DesignState> start_mixed(const CandidateView& view, std::vector<int> members,
                                         const std::vector<VariantGroup>& variants, bool minimum) {
  std::vector<Scenario> scenarios;
  scenarios.reserve(variants.size());
  for (const VariantGroup& group : variants) {
    Eigen::MatrixXd prior;
    if (view.prior != nullptr) prior = view.prior->block(group.first, group.first, group.columns, group.columns);
    scenarios.push_back({std::make_shared<BlockArray>(own_blocks(*view.blocks, group)), group.nuisance, group.weight,
                         group.reference, std::move(prior)});
  }
  return start_mixed(view, std::move(members), scenarios, aim_of(minimum), 1.0);
}

std::unique_ptr<DesignState> start_mixed(const CandidateView& view, std::vector<int> members,
                                         const std::vector<Scenario>& scenarios, const RobustAim& aim, double whole) {
  return std::make_unique<MixedState>(view, std::move(members), scenarios, aim, whole);
}

}  // namespace posewright
