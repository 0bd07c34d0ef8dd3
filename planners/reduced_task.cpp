#include "reduced_task.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "posewright/criterion/information_function.hpp"
#include "posewright/criterion/summed_information.hpp"

namespace posewright {
namespace {

// Share of the price below which a candidate is left out; few parameters need a wider net (measured on the instances
// of docs/benchmarks.md).
constexpr double share_many = 0.8, share_few = 0.6;
constexpr int few_parameters = 8;
// Candidates at once where Φ has no bound and there are no weights: each exchange computes all of them anew.
constexpr std::size_t compared = 400;

std::vector<int> promising(const DesignTask& task) {
  const ApproximateDesign& w = *task.approximate;
  const int parameters = task.candidates.blocks->columns() - task.candidates.nuisance;
  const double threshold = (parameters <= few_parameters ? share_few : share_many) * w.price;
  const auto nth_largest = [&](int count) {
    const auto nth = std::min(w.sensitivity.size(), std::size_t(count)) - 1;
    std::vector<double> sorted = w.sensitivity;
    std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(nth), sorted.end(), std::greater<>());
    return sorted[nth];
  };
  // Enough to choose from, whatever the threshold says; and no more than an exchange can compare quickly where
  // (almost) all candidates are alike, as the poses of an arm are.
  const int columns = task.candidates.blocks->columns();
  // Blocks of several rows differ less from each other than rows do; with nuisance columns they need more again.
  const int each = task.candidates.blocks->rows() > 1 && task.candidates.nuisance == 0 ? 20 : 40;
  const double limit = std::max(nth_largest(std::max(each * columns, 20 * task.poses)),
                                std::min(threshold, nth_largest(std::max(10 * task.poses, 200))));
  std::vector<int> kept;
  for (std::size_t i = 0; i < w.sensitivity.size(); ++i)
    if (w.sensitivity[i] >= limit) kept.push_back(int(i));
  return kept;
}

/// At a minimum distance the promising ones may lie in a few places that cannot hold a plan: the best ones that are
/// apart from each other, some to choose from.
void add_apart(const DesignTask& task, std::vector<int>& kept) {
  const std::vector<double>& sensitivity = task.approximate->sensitivity;
  std::vector<int> order(sensitivity.size()), apart;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return sensitivity[std::size_t(a)] > sensitivity[std::size_t(b)]; });
  for (const int i : order) {
    if (int(apart.size()) >= 3 * task.poses) break;
    if (task.candidates.spacing->admits(apart, i)) apart.push_back(i);
  }
  kept.insert(kept.end(), apart.begin(), apart.end());
}

/// Some of all candidates, evenly through their order.
std::vector<int> spread_evenly(std::size_t all) {
  std::vector<int> some;
  for (std::size_t i = 0; i < compared; ++i) some.push_back(int(i * all / compared));
  return some;
}

/// Candidates with the largest derivative of Φ at the members; where Φ is −∞ any.
std::vector<int> steepest(const DesignTask& task, const std::vector<int>& members) {
  const BlockArray& blocks = *task.candidates.blocks;
  const Eigen::MatrixXd M = summed_information(blocks, task.candidates.prior, members);
  const InformationFunction& function = task.criterion->function();
  if (!std::isfinite(function.value(M))) return spread_evenly(blocks.count());
  const Eigen::MatrixXd S = function.gradient(M);
  std::vector<double> gain(blocks.count());
  for (std::size_t i = 0; i < gain.size(); ++i) {
    const auto J = blocks.block(i);
    gain[i] = (J * S).cwiseProduct(J).sum();
  }
  std::vector<int> order(blocks.count());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return gain[std::size_t(i)] > gain[std::size_t(j)]; });
  order.resize(compared);
  return order;
}

}  // namespace

bool promises_by_members(const DesignTask& task) {
  return task.approximate == nullptr && task.criterion->function().degree() == 0 &&
         task.candidates.blocks->count() > compared;
}

ReducedTask::ReducedTask(const DesignTask& task, const std::vector<int>& also) : task_(task) {
  std::vector<int> kept;
  if (promises_by_members(task)) {
    kept = also.empty() ? spread_evenly(task.candidates.blocks->count()) : steepest(task, also);
  } else {
    if (task.approximate == nullptr || task.approximate->sensitivity.size() != task.candidates.blocks->count()) return;
    kept = promising(task);
    if (task.candidates.spacing != nullptr) add_apart(task, kept);
    if (2 * kept.size() > task.candidates.blocks->count()) return;
  }
  kept.insert(kept.end(), also.begin(), also.end());
  keep(task, std::move(kept));
}

void ReducedTask::keep(const DesignTask& task, std::vector<int> kept) {
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  kept_ = std::move(kept);
  blocks_ = task.candidates.blocks->subset(kept_);
  task_.candidates.blocks = &blocks_;
  if (task.approximate != nullptr) take_weights(*task.approximate);
  // Configurations are those of the whole task; a planner that needs them works on that.
  task_.space = nullptr;
  if (task.candidates.spacing == nullptr) return;
  spacing_ = task.candidates.spacing->of(kept_);
  task_.candidates.spacing = &spacing_;
}

void ReducedTask::take_weights(const ApproximateDesign& whole) {
  for (std::size_t i = 0; i < whole.support.size(); ++i) {
    const auto at = std::lower_bound(kept_.begin(), kept_.end(), whole.support[i]);
    if (at == kept_.end() || *at != whole.support[i]) continue;
    approximate_.support.push_back(int(at - kept_.begin()));
    approximate_.weights.push_back(whole.weights[i]);
  }
  task_.approximate = &approximate_;
}

std::vector<int> ReducedTask::reduced(const std::vector<int>& members) const {
  if (!is_smaller()) return members;
  std::vector<int> inside;
  for (const int i : members) inside.push_back(int(std::lower_bound(kept_.begin(), kept_.end(), i) - kept_.begin()));
  return inside;
}

std::vector<int> ReducedTask::original(const std::vector<int>& members) const {
  if (!is_smaller()) return members;
  std::vector<int> original;
  original.reserve(members.size());
  for (const int i : members) original.push_back(kept_[std::size_t(i)]);
  return original;
}

}  // namespace posewright
