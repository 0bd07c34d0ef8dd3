#include "posewright/planning/approximate_design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "posewright/criterion/sensitivity.hpp"
#include "posewright/support/error.hpp"
#include "restricted_design.hpp"

namespace posewright {
namespace {

// Less is what an interior point leaves on candidates that are in no solution.
constexpr double trace_of_weight = 1e-6;

/// Indices of the `count` largest values among `among`, ties by index.
std::vector<int> largest(const std::vector<double>& value, std::vector<int> among, std::size_t count) {
  count = std::min(count, among.size());
  const auto before = [&](int a, int b) {
    return value[std::size_t(a)] != value[std::size_t(b)] ? value[std::size_t(a)] > value[std::size_t(b)] : a < b;
  };
  std::nth_element(among.begin(), among.begin() + std::ptrdiff_t(count), among.end(), before);
  among.resize(count);
  return among;
}

/// Longest rows plus a draw from every stretch of the array.
std::vector<int> first_working_set(const BlockArray& blocks, std::size_t size) {
  const std::size_t n = blocks.count();
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  if (size >= n) return all;
  std::vector<double> length(n);
  for (std::size_t i = 0; i < n; ++i) length[i] = blocks.block(i).squaredNorm();
  std::vector<int> set = largest(length, all, size / 2);
  return with_drawn(std::move(set), n, size);
}

/// Keeps candidates that carry weight or may still gain some, at least `least`; adds the worst violators of the price.
std::vector<int> next_working_set(const RestrictedDesign& restricted, const std::vector<double>& d, std::size_t least,
                                  std::size_t room) {
  const double price = restricted.price();
  std::vector<bool> kept(d.size(), false);
  std::vector<int> set;
  const double negligible = 1e-6 / double(restricted.candidates().size());
  for (std::size_t i = 0; i < restricted.candidates().size(); ++i) {
    const int c = restricted.candidates()[i];
    const std::size_t left = restricted.candidates().size() - i;
    if (set.size() + left > least && restricted.weights()[Eigen::Index(i)] < negligible &&
        d[std::size_t(c)] < 0.98 * price)
      continue;
    set.push_back(c);
    kept[std::size_t(c)] = true;
  }
  std::vector<int> violators;
  for (std::size_t i = 0; i < d.size(); ++i)
    if (!kept[i] && d[i] > price * (1 - 1e-12)) violators.push_back(int(i));
  for (const int c : largest(d, violators, room)) set.push_back(c);
  std::sort(set.begin(), set.end());
  return set;
}

/// cap = 1/n: the only feasible weights.
ApproximateDesign all_alike(const BlockArray& blocks, const InformationFunction& function,
                            const ApproximateDesignOptions& options) {
  const auto n = blocks.count();
  RestrictedDesign restricted(blocks, function, 1.0, options.prior);
  ApproximateDesign result;
  result.support.resize(n);
  std::iota(result.support.begin(), result.support.end(), 0);
  result.weights.assign(n, 1.0 / double(n));
  if (!restricted.set_candidates(result.support))
    throw CannotDo("the parameters cannot be identified from these candidates: the information is singular");
  sensitivities(blocks, restricted.factor(), options.threads, result.sensitivity);
  result.value = restricted.value();
  result.bound = with_margin(result.value);
  result.degree = function.degree();
  result.factor = restricted.factor();
  result.rounds = 1;
  return result;
}

}  // namespace

std::vector<int> ApproximateDesign::weighted() const {
  std::vector<int> result;
  for (std::size_t i = 0; i < support.size(); ++i)
    if (weights[i] > trace_of_weight) result.push_back(support[i]);
  return result;
}

double ApproximateDesign::bound_for(int poses) const { return bound + degree * std::log(double(poses)); }

ApproximateDesign solve_approximate_design(const BlockArray& blocks, const InformationFunction& function,
                                           const ApproximateDesignOptions& options, const Monitor& monitor) {
  const std::size_t n = blocks.count();
  const int m = blocks.columns();
  const double degree = function.degree();
  if (!(degree > 0)) throw std::invalid_argument("approximate design: the criterion has no bound");
  // As many candidates as it takes to hold all weight.
  const auto top = std::size_t(std::ceil(1 / options.cap - 1e-9));
  if (n == 0 || top > n)
    throw std::invalid_argument("approximate design: the cap times the number of candidates is below 1");
  const std::size_t start = std::max<std::size_t>({std::size_t(6 * m), 4 * top, 50});
  const std::size_t room = std::max<std::size_t>(std::size_t(3 * m), 2 * top);

  if (std::abs(options.cap * double(n) - 1) < 1e-12) return all_alike(blocks, function, options);
  RestrictedDesign restricted(blocks, function, options.cap, options.prior);
  std::size_t size = start;
  const bool warm = options.start.size() >= 2 * top && restricted.set_candidates(options.start);
  while (!warm && !restricted.set_candidates(first_working_set(blocks, size))) {
    if (size >= n)
      throw CannotDo("the parameters cannot be identified from these candidates: the information is singular");
    size *= 4;
  }
  ApproximateDesign result;
  result.degree = degree;
  result.bound = std::numeric_limits<double>::infinity();
  std::vector<double> d(n);
  double gap = 1.0;
  int unchanged = 0;
  const Monitor unstopped;
  for (int round = 1;; ++round) {
    // Whoever stops before the first round is done still gets a bound that says something.
    const double wanted = std::max(0.2 * options.tolerance, 0.03 * std::min(gap, 1.0));
    result.newton_steps += restricted.solve(wanted, round == 1 ? unstopped : monitor);
    sensitivities(blocks, restricted.factor(), options.threads, d);
    const double ratio = std::max(1.0, (best_mean(d, options.cap) + restricted.prior_sensitivity()) / degree);
    const double bound = with_margin(restricted.value() + degree * std::log(ratio));
    gap = ratio - 1;
    monitor.report({"certificate", double(round), 0, {}, {}, std::exp(-(bound - restricted.value()) / degree)});
    if (bound <= result.bound) {
      result.value = restricted.value();
      result.max_sensitivity_ratio = ratio;
      result.bound = bound;
      result.factor = restricted.factor();
      result.price = restricted.price();
      result.sensitivity = d;
      result.support = restricted.candidates();
      result.weights.assign(restricted.weights().data(), restricted.weights().data() + restricted.weights().size());
    }
    result.rounds = round;
    result.stopped = monitor.should_stop();
    const double tolerance =
        restricted.candidates().size() > most_settled ? std::max(options.tolerance, settled_gap) : options.tolerance;
    if (gap <= tolerance || round == options.max_rounds || result.stopped) break;
    const std::vector<int> next = next_working_set(restricted, d, std::min(n, 2 * top), room);
    // Nothing left to add: what remains is the accuracy of the weights (a fresh centre helps), or rounding.
    if (next == restricted.candidates() && ++unchanged > 3) break;
    if (!restricted.set_candidates(next)) break;
  }
  return result;
}

}  // namespace posewright
