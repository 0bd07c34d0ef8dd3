#include "posewright/criterion/reserve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/criterion/information_function.hpp"
#include "posewright/criterion/sensitivity.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

constexpr std::size_t most_evaluated_in_reserve = 12;

class ReserveState : public DesignState {
 public:
  ReserveState(const CandidateView& view, std::vector<int> members, const InformationFunction& function)
      : DesignState(view, std::move(members)), function_(function) {
    refresh();
  }

  double value() const override { return singular_ ? -infinity : value_; }
  double loss(int position) const override { return d_[std::size_t(members()[std::size_t(position)])]; }

  Swap best_addition() override {
    Swap best{-1, -infinity};
    std::vector<int> after = members();
    after.push_back(-1);
    for (const int j : promising()) {
      after.back() = j;
      const double gain = worst(information_ + square(j), after).first - value_;
      if (best.enter < 0 || gain > best.gain) best = {j, gain};
    }
    return best;
  }

  double removal(int position) override {
    std::vector<int> after = members();
    const int leave = after[std::size_t(position)];
    after.erase(after.begin() + position);
    return worst(information_ - square(leave), after).first - value_;
  }

  bool refresh() override {
    information_ = summed_information(blocks(), view().prior, members());
    singular_ = !std::isfinite(worst(information_, members()).first);
    // Two poses' worth of ridge: one may be taken away.
    if (singular_) information_.diagonal().array() += start_ridge;
    update();
    return !singular_;
  }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    std::vector<int> after = members();
    const int leave = after[std::size_t(position)];
    const Eigen::MatrixXd rest = information_ - square(leave);
    Swap best{-1, min_gain};
    for (const int j : promising()) {
      after[std::size_t(position)] = j;
      const double gain = worst(rest + square(j), after).first - value_;
      if (gain > best.gain) best = {j, gain};
    }
    return best.enter < 0 ? Swap{} : best;
  }

  void do_change(int leave, int enter) override {
    if (enter >= 0) information_ += square(enter);
    if (leave >= 0) information_ -= square(leave);
    if (singular_ || !std::isfinite(worst(information_, members()).first)) refresh();
    else update();
  }

  Eigen::MatrixXd square(int i) const { return block_information(blocks(), i); }

  /// Smallest Φ(M − JᵀJ) over the members, and whose loss that is.
  std::pair<double, int> worst(const Eigen::MatrixXd& information, const std::vector<int>& set) const {
    std::pair<double, int> least{set.empty() ? function_.value(information) : infinity, -1};
    for (const int i : set) {
      const double value = function_.value(information - square(i));
      if (value < least.first || least.second < 0) least = {value, i};
      if (!std::isfinite(value)) break;
    }
    return least;
  }

  void update() {
    const auto [value, whose] = worst(information_, members());
    value_ = value;
    Eigen::MatrixXd rest = information_;
    if (whose >= 0) rest -= square(whose);
    // Where even the ridge does not help, the whole design's derivative shows the way.
    if (!std::isfinite(function_.value(rest))) {
      rest = information_;
      rest.diagonal().array() += start_ridge;
      value_ = function_.value(rest);
    }
    const Eigen::MatrixXd S = function_.gradient(rest);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(S);
    const Eigen::MatrixXd half = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
    sensitivities(blocks(), upper_factor(half), 1, d_);
  }

  /// Candidates of largest derivative that may enter, largest first; ties by index.
  std::vector<int> promising() const {
    std::vector<int> order;
    for (int j = 0; j < int(d_.size()); ++j)
      if (may_enter(j)) order.push_back(j);
    keep_largest(order, d_, most_evaluated_in_reserve);
    return order;
  }

  const InformationFunction& function_;
  Eigen::MatrixXd information_;
  std::vector<double> d_;
  double value_ = 0.0;
  bool singular_ = false;
};

}  // namespace

std::unique_ptr<DesignState> ReserveCriterion::start(const CandidateView& view, std::vector<int> members) const {
  return std::make_unique<ReserveState>(view, std::move(members), inner_.function());
}

}  // namespace posewright
