#include "starts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "posewright/support/error.hpp"

namespace posewright {
namespace {

/// Candidates chosen so far, within the repeat policy.
class Selection {
 public:
  explicit Selection(const DesignTask& task) : task_(task) {}
  bool full() const { return int(members_.size()) == task_.poses; }
  bool add(int candidate) {
    int& used = used_[candidate];
    if (full() || used >= task_.candidates.max_repeats) return false;
    if (task_.candidates.spacing != nullptr && !task_.candidates.spacing->admits(members_, candidate)) return false;
    ++used;
    members_.push_back(candidate);
    return true;
  }
  void fill_uniformly(Random& random) {
    const int n = int(task_.candidates.blocks->count());
    // Rejection is quick while most candidates are free; a sweep finishes crowded cases.
    for (int tries = 0; !full() && tries < 20 * task_.poses; ++tries) add(random.index(n));
    for (int i = 0, first = random.index(n); !full() && i < n; ++i)
      while (add((first + i) % n)) continue;
    if (!full())
      throw CannotDo("only " + std::to_string(members_.size()) + " of " + std::to_string(task_.poses) +
                     " poses were found at the minimum distance from each other and within the limits");
  }
  std::vector<int> take() { return std::move(members_); }

 private:
  const DesignTask& task_;
  std::unordered_map<int, int> used_;
  std::vector<int> members_;
};

}  // namespace

std::vector<int> rounded_start(const DesignTask& task) {
  const ApproximateDesign& w = *task.approximate;
  Selection selection(task);
  for (std::size_t i = 0; i < w.support.size(); ++i)
    for (int k = int(std::floor(w.weights[i] * task.poses * (1 + 1e-9))); k > 0; --k) selection.add(w.support[i]);
  std::vector<std::size_t> order(w.support.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto remainder = [&](std::size_t i) {
    const double x = w.weights[i] * task.poses;
    return x - std::floor(x);
  };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return remainder(a) > remainder(b); });
  for (const std::size_t i : order) selection.add(w.support[i]);
  Random random(0, 0);
  selection.fill_uniformly(random);
  return selection.take();
}

std::vector<int> weighted_start(const DesignTask& task, Random& random) {
  const ApproximateDesign& w = *task.approximate;
  std::vector<double> cumulative(w.weights.size());
  std::partial_sum(w.weights.begin(), w.weights.end(), cumulative.begin());
  Selection selection(task);
  for (int tries = 0; !selection.full() && tries < 10 * task.poses; ++tries) {
    const auto at = std::upper_bound(cumulative.begin(), cumulative.end(), random.uniform() * cumulative.back());
    const auto i = std::min<std::size_t>(std::size_t(at - cumulative.begin()), w.support.size() - 1);
    selection.add(w.support[i]);
  }
  selection.fill_uniformly(random);
  return selection.take();
}

std::vector<int> uniform_start(const DesignTask& task, Random& random) {
  Selection selection(task);
  selection.fill_uniformly(random);
  return selection.take();
}

}  // namespace posewright
