#include "posewright/criterion/information_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "posewright/criterion/sensitivity.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

// Exact evaluations for one position. Of concave criteria most are cut off by the derivative before.
constexpr std::size_t most_evaluated = 16;

class FunctionState : public DesignState {
 public:
  FunctionState(const CandidateView& view, std::vector<int> members,
                std::shared_ptr<const InformationFunction> function)
      : DesignState(view, std::move(members)), function_(std::move(function)), prior_(view.prior) {
    refresh();
  }

  double value() const override { return singular_ ? -infinity : value_; }
  double loss(int position) const override { return d_[std::size_t(members()[std::size_t(position)])]; }

  Swap best_addition() override {
    Swap best{-1, -infinity};
    for (const int j : promising(-infinity)) {
      if (function_->concave() && d_[std::size_t(j)] <= best.gain) break;
      const double gain = function_->value(information_ + square(j)) - value_;
      if (gain > best.gain) best = {j, gain};
    }
    return best;
  }

  double removal(int position) override {
    return function_->value(information_ - square(members()[std::size_t(position)])) - value_;
  }

  bool refresh() override {
    const auto m = blocks().columns();
    information_ = summed_information(blocks(), prior_, members());
    singular_ = !std::isfinite(function_->value(information_));
    if (singular_) information_ += start_ridge * Eigen::MatrixXd::Identity(m, m);
    update();
    return !singular_;
  }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    const int k = members()[std::size_t(position)];
    const Eigen::MatrixXd rest = information_ - square(k);
    const std::vector<int> order = promising(function_->concave() ? d_[std::size_t(k)] + min_gain : -infinity);
    Swap best{-1, min_gain};
    for (const int j : order) {
      if (function_->concave() && d_[std::size_t(j)] - d_[std::size_t(k)] <= best.gain) break;
      const double gain = function_->value(rest + square(j)) - value_;
      if (gain > best.gain) best = {j, gain};
    }
    return best.enter < 0 ? Swap{} : best;
  }

  void do_change(int leave, int enter) override {
    if (enter >= 0) information_ += square(enter);
    if (leave >= 0) information_ -= square(leave);
    // A start that was singular may have become regular.
    if (singular_ || !std::isfinite(function_->value(information_))) refresh();
    else update();
  }

  Eigen::MatrixXd square(int i) const { return block_information(blocks(), i); }

  /// Value and the derivative along every candidate, one pass over all rows.
  void update() {
    value_ = function_->value(information_);
    const BlockArray::RowMatrix S = function_->gradient(information_);
    d_.assign(blocks().count(), 0.0);
    constexpr std::size_t chunk = 512;
    BlockArray::RowMatrix projected;
    const auto all = blocks().all();
    const int r = blocks().rows();
    for (std::size_t first = 0; first < d_.size(); first += chunk) {
      const std::size_t count = std::min(chunk, d_.size() - first);
      const auto rows = all.middleRows(Eigen::Index(first) * r, Eigen::Index(count) * r);
      projected.noalias() = rows * S;
      for (std::size_t i = 0; i < count; ++i)
        d_[first + i] =
            projected.middleRows(Eigen::Index(i) * r, r).cwiseProduct(rows.middleRows(Eigen::Index(i) * r, r)).sum();
    }
  }

  /// Candidates of largest derivative that may enter, largest first; ties by index.
  std::vector<int> promising(double threshold) const {
    std::vector<int> order;
    for (int j = 0; j < int(d_.size()); ++j)
      if (blocked()[std::size_t(j)] == 0 && d_[std::size_t(j)] > threshold) order.push_back(j);
    keep_largest(order, d_, most_evaluated);
    return order;
  }

  std::shared_ptr<const InformationFunction> function_;
  const Eigen::MatrixXd* prior_;
  Eigen::MatrixXd information_;
  std::vector<double> d_;
  double value_ = 0.0;
  bool singular_ = false;
};

}  // namespace

std::unique_ptr<BlockFunction> InformationFunction::with_block(const Eigen::MatrixXd& information) const {
  class OfTheSum : public BlockFunction {
   public:
    OfTheSum(const InformationFunction& function, const Eigen::MatrixXd& rest) : function_(function), rest_(rest) {}
    double value(const BlockArray::ConstMap& J) override {
      sum_ = rest_;
      sum_.noalias() += J.transpose() * J;
      return function_.value(sum_);
    }

   private:
    const InformationFunction& function_;
    Eigen::MatrixXd rest_, sum_;
  };
  return std::make_unique<OfTheSum>(*this, information);
}

std::unique_ptr<Expansion> InformationFunction::expand(const Eigen::MatrixXd&) const {
  throw std::logic_error("this criterion has no expansion");
}

Eigen::MatrixXd upper_factor(const Eigen::MatrixXd& F) {
  // With P reversing rows and (P F)ᵀ = Q R: F Fᵀ = (P Rᵀ P)(P R P), and P Rᵀ P is upper triangular.
  const Eigen::Index m = F.rows();
  Eigen::MatrixXd reversed = Eigen::MatrixXd::Zero(std::max(F.cols(), m), m);
  reversed.topRows(F.cols()) = F.colwise().reverse().transpose();
  const Eigen::MatrixXd R =
      Eigen::HouseholderQR<Eigen::MatrixXd>(reversed).matrixQR().topRows(m).triangularView<Eigen::Upper>();
  return R.transpose().reverse();
}

FunctionCriterion::FunctionCriterion(std::string name, std::shared_ptr<const InformationFunction> function)
    : name_(std::move(name)), function_(std::move(function)) {}

std::unique_ptr<DesignState> FunctionCriterion::start(const CandidateView& view, std::vector<int> members) const {
  return std::make_unique<FunctionState>(view, std::move(members), function_);
}

}  // namespace posewright
