#include "posewright/planning/limited_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "posewright/criterion/sensitivity.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "restricted_design.hpp"

namespace posewright {
namespace {

// Passes over all blocks, and steps between two; measured on mixes of two instruments, which end after three passes.
constexpr int most_passes = 12, most_steps = 300;
// Share of Φ's degree that is close enough: a ten-thousandth of an efficiency.
constexpr double close_enough = 1e-4;

std::vector<int> by_sensitivity(const std::vector<double>& d) {
  std::vector<int> order(d.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return d[std::size_t(a)] > d[std::size_t(b)]; });
  return order;
}

class LimitedWeights {
 public:
  LimitedWeights(const LimitedChoice& choice, const InformationFunction& function, const ApproximateDesign& start,
                 int threads)
      : choice_(choice), function_(function), threads_(threads), weights_(choice.blocks.count(), 0.0) {
    for (std::size_t i = 0; i < start.support.size(); ++i) weights_[std::size_t(start.support[i])] = start.weights[i];
    // A value of the limited coordinate without weight could never get any.
    const std::vector<double>& d = start.sensitivity;
    std::vector<int> taken(choice.spacing.most.size(), 0);
    for (const int i : d.empty() ? std::vector<int>() : by_sensitivity(d))
      if (int& own = taken[choice.spacing.value_at(i)]; own < choice.blocks.columns()) {
        ++own;
        weights_[std::size_t(i)] += 1e-3 / choice.blocks.columns();
      }
    keep_limits();
  }

  /// Improves the weights on those that have some, until they are as good as these can be.
  void improve(const Monitor& monitor) {
    std::vector<int> support;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (weights_[i] > 0) support.push_back(int(i));
    const BlockArray blocks = choice_.blocks.subset(support);
    std::vector<double> d;
    for (int step = 0; step < most_steps && !monitor.should_stop(); ++step) {
      const auto at = function_.expand(information());
      if (at == nullptr) return;
      sensitivities(blocks, at->factor, threads_, d);
      double sum = 0.0;
      for (std::size_t i = 0; i < support.size(); ++i) sum += weights_[std::size_t(support[i])] * d[i];
      if (best_mean(support, d) - sum < close_enough * function_.degree()) return;
      for (std::size_t i = 0; i < support.size(); ++i) weights_[std::size_t(support[i])] *= d[i];
      keep_limits();
    }
  }

  /// One pass over all blocks. Those that the best plan by their sensitivities takes get weight.
  /// @return the bound of N poses, and whether the weights are close to it
  std::pair<double, bool> prove() {
    const auto at = function_.expand(information());
    const double h = function_.degree();
    if (at == nullptr) return {std::numeric_limits<double>::infinity(), true};
    std::vector<double> d;
    sensitivities(choice_.blocks, at->factor, threads_, d);
    double known = 0.0, sum = 0.0;
    if (choice_.prior.size() > 0) known = (at->factor.transpose() * choice_.prior * at->factor).trace();
    for (std::size_t i = 0; i < d.size(); ++i) sum += weights_[i] * d[i];
    std::vector<int> all(d.size());
    std::iota(all.begin(), all.end(), 0);
    const double mean = best_mean(all, d);
    const double bound = at->value + h * std::log((known + mean) / h) + h * std::log(double(choice_.poses));
    const bool close = mean - sum < close_enough * h;
    for (double& weight : weights_) weight *= 1 - entering;
    for (const auto& [i, count] : taken_) weights_[std::size_t(i)] += entering * count / choice_.poses;
    return {with_margin(bound), close};
  }

 private:
  static constexpr double entering = 0.1;

  Eigen::MatrixXd information() const {
    CandidateWeights positive;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (weights_[i] > 0) positive.emplace_back(int(i), weights_[i]);
    return weighted_information(choice_.blocks, choice_.prior, positive);
  }

  /// Largest mean of d over plans of these blocks within the limits; `taken_` has which it takes, and how often.
  double best_mean(const std::vector<int>& blocks, const std::vector<double>& d) {
    std::vector<int> free = choice_.spacing.most;
    taken_.clear();
    int left = choice_.poses;
    double sum = 0.0;
    for (const int i : by_sensitivity(d)) {
      const int block = blocks[std::size_t(i)];
      int& own = free[choice_.spacing.value_at(block)];
      const int count = std::min({left, own, choice_.repeats});
      if (count == 0) continue;
      own -= count;
      left -= count;
      sum += count * d[std::size_t(i)];
      taken_.emplace_back(block, count);
      if (left == 0) break;
    }
    return sum / choice_.poses;
  }

  /// Scales the weights of each value to what its limit allows and the others to the rest, so that all add to one.
  void keep_limits() {
    const std::size_t values = choice_.spacing.most.size();
    std::vector<double> share(values, 0.0), scale(values, 1.0);
    for (std::size_t i = 0; i < weights_.size(); ++i) share[choice_.spacing.value_at(int(i))] += weights_[i];
    std::vector<bool> full(values, false);
    for (bool changed = true; changed;) {
      changed = false;
      double rest = 1.0, free = 0.0;
      for (std::size_t v = 0; v < values; ++v) (full[v] ? rest : free) += full[v] ? -allowed(v) : share[v];
      for (std::size_t v = 0; v < values; ++v) {
        if (full[v]) continue;
        scale[v] = free > 0 ? rest / free : 0.0;
        if (share[v] * scale[v] <= allowed(v)) continue;
        full[v] = changed = true;
        scale[v] = share[v] > 0 ? allowed(v) / share[v] : 0.0;
      }
    }
    for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] *= scale[choice_.spacing.value_at(int(i))];
  }
  double allowed(std::size_t value) const { return std::min(1.0, double(choice_.spacing.most[value]) / choice_.poses); }

  const LimitedChoice& choice_;
  const InformationFunction& function_;
  int threads_;
  std::vector<double> weights_;
  std::vector<std::pair<int, int>> taken_;
};

}  // namespace

double limited_bound(const LimitedChoice& choice, const InformationFunction& function, const ApproximateDesign& start,
                     int threads, const Monitor& monitor) {
  LimitedWeights weights(choice, function, start, threads);
  double least = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < most_passes; ++pass) {
    weights.improve(monitor);
    const auto [bound, close] = weights.prove();
    least = std::min(least, bound);
    if (close || monitor.should_stop()) break;
  }
  return least;
}

}  // namespace posewright
