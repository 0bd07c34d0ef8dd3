#include "posewright/planning/extended_bound.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "posewright/criterion/sensitivity.hpp"
#include "restricted_design.hpp"

namespace posewright {
namespace {

constexpr int most_rounds = 10;
constexpr auto grace = std::chrono::milliseconds(300);

BlockArray joined(const BlockArray& candidates, const std::vector<int>& kept, const BlockArray& more) {
  const BlockArray part = candidates.subset(kept);
  BlockArray pool(part.count() + more.count(), part.rows(), part.columns());
  const auto length = std::size_t(part.rows() * part.stride());
  std::copy_n(part.data(), part.count() * length, pool.data());
  std::copy_n(more.data(), more.count() * length, pool.row(part.count(), 0));
  return pool;
}

/// Candidates of largest d, ascending by index.
std::vector<int> largest(const std::vector<double>& d, std::size_t count) {
  std::vector<int> order(d.size());
  std::iota(order.begin(), order.end(), 0);
  keep_largest(order, d, count);
  std::sort(order.begin(), order.end());
  return order;
}

std::vector<int> united(std::vector<int> a, const std::vector<int>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

}  // namespace

ApproximateDesign extended_bound(const BlockArray& candidates, const ApproximateDesign& design, const BlockArray& more,
                                 const InformationFunction& function, const ApproximateDesignOptions& options,
                                 const Monitor& monitor) {
  // Of a search that was stopped the bound is what is stated: it gets a moment of its own.
  Monitor moment;
  moment.deadline = Monitor::Clock::now() + grace;
  const Monitor& watch = monitor.should_stop() ? moment : monitor;
  const auto room = std::max(std::size_t(10 * candidates.columns()), std::size_t(4 / options.cap));
  std::vector<int> kept = united(largest(design.sensitivity, room), design.support);
  ApproximateDesign best;
  // Weights of the round before: on candidates by their own index, on more from the number of candidates on.
  std::vector<int> weighted = design.weighted();
  const int count = int(candidates.count());
  ApproximateDesignOptions warm = options;
  for (int round = 0; round < most_rounds; ++round) {
    warm.start.clear();
    for (const int i : weighted)
      warm.start.push_back(i < count ? int(std::lower_bound(kept.begin(), kept.end(), i) - kept.begin())
                                     : i - count + int(kept.size()));
    ApproximateDesign now = solve_approximate_design(joined(candidates, kept, more), function, warm, watch);
    weighted = now.weighted();
    for (int& i : weighted) i = i < int(kept.size()) ? kept[std::size_t(i)] : i - int(kept.size()) + count;
    std::vector<double> d;
    sensitivities(candidates, now.factor, options.threads, d);
    std::vector<double> all = d;
    all.insert(all.end(), now.sensitivity.end() - std::ptrdiff_t(more.count()), now.sensitivity.end());
    const double prior = options.prior.size() > 0 ? (now.factor.transpose() * options.prior * now.factor).trace() : 0.0;
    now.max_sensitivity_ratio = std::max(1.0, (best_mean(std::move(all), options.cap) + prior) / now.degree);
    now.bound = with_margin(now.value + now.degree * std::log(now.max_sensitivity_ratio));
    // Where weights cannot be found more exactly another round finds others that are as good: it moves the bound by
    // less than anybody reads.
    const bool first = round == 0;
    const bool stalled = !first && now.max_sensitivity_ratio - 1 > 0.5 * (best.max_sensitivity_ratio - 1);
    if (first || now.bound < best.bound) best = std::move(now);
    if (stalled) break;
    if (best.max_sensitivity_ratio <= 1 + std::max(options.tolerance, 1e-9) || watch.should_stop()) break;
    std::vector<int> next = united(kept, largest(d, room));
    if (next == kept) break;
    kept = std::move(next);
  }
  return best;
}

}  // namespace posewright
