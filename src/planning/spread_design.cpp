#include "posewright/planning/spread_design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "posewright/support/error.hpp"
#include "posewright/support/tasks.hpp"
#include "restricted_design.hpp"

namespace posewright {
namespace {

/// The blocks that have been in a working set, on every process.
class Pool {
 public:
  explicit Pool(SpreadBlocks& candidates)
      : candidates_(candidates), blocks_(0, candidates.rows(), candidates.columns()) {}

  const BlockArray& blocks() const { return blocks_; }
  int candidate(int place) const { return known_[std::size_t(place)]; }
  /// The places of some candidates (ascending); those that are new are fetched.
  std::vector<int> places(const std::vector<int>& wanted) {
    std::vector<int> missing, result;
    for (const int c : wanted)
      if (std::find(known_.begin(), known_.end(), c) == known_.end()) missing.push_back(c);
    if (!missing.empty()) append(candidates_.fetch(missing), missing);
    for (const int c : wanted) result.push_back(int(std::find(known_.begin(), known_.end(), c) - known_.begin()));
    return result;
  }

 private:
  void append(const BlockArray& more, const std::vector<int>& names) {
    BlockArray all(blocks_.count() + more.count(), more.rows(), more.columns());
    const std::size_t block = std::size_t(all.rows()) * std::size_t(all.stride());
    std::copy_n(blocks_.data(), blocks_.count() * block, all.data());
    std::copy_n(more.data(), more.count() * block, all.row(blocks_.count(), 0));
    blocks_ = std::move(all);
    known_.insert(known_.end(), names.begin(), names.end());
  }

  SpreadBlocks& candidates_;
  BlockArray blocks_;
  std::vector<int> known_;
};

/// Longest blocks and a draw from every stretch, as solve_approximate_design() begins.
std::vector<int> first_working_set(SpreadBlocks& candidates, std::size_t size) {
  const std::size_t n = candidates.count();
  std::vector<int> set;
  if (size >= n) {
    set.resize(n);
    std::iota(set.begin(), set.end(), 0);
    return set;
  }
  candidates.pass(Eigen::MatrixXd::Identity(candidates.columns(), candidates.columns()));
  for (const auto& one : candidates.largest(size / 2, -1.0, {})) set.push_back(one.candidate);
  return with_drawn(std::move(set), n, size);
}

/// Mean of the largest d: Σ v_i d_i at most, over 0 ≤ v ≤ cap and Σv = 1.
double largest_mean(SpreadBlocks& candidates, double cap) {
  const auto top = std::size_t(std::ceil(1 / cap - 1e-9));
  std::vector<double> values;
  for (const auto& one : candidates.largest(top, -1.0, {})) values.push_back(one.value);
  double rest = 1.0, sum = 0.0;
  for (const double value : values) {
    const double share = std::min(cap, rest);
    sum += share * value;
    rest -= share;
  }
  return sum;
}

/// Candidates with weight, at least `least`, and the worst violators of the price.
std::vector<int> next_working_set(const RestrictedDesign& restricted, const Pool& pool, SpreadBlocks& candidates,
                                  std::size_t least, std::size_t room) {
  const std::size_t size = restricted.candidates().size();
  const double price = restricted.price(), negligible = 1e-6 / double(size);
  std::vector<int> set;
  for (std::size_t i = 0; i < size; ++i) {
    const int place = restricted.candidates()[i];
    const double d = (pool.blocks().block(std::size_t(place)) * restricted.factor()).squaredNorm();
    if (set.size() + size - i > least && restricted.weights()[Eigen::Index(i)] < negligible && d < 0.98 * price)
      continue;
    set.push_back(pool.candidate(place));
  }
  std::sort(set.begin(), set.end());
  const auto violators = candidates.largest(room, price * (1 - 1e-12), set);
  for (const auto& one : violators) set.push_back(one.candidate);
  std::sort(set.begin(), set.end());
  return set;
}

void keep(ApproximateDesign& result, const RestrictedDesign& restricted, const Pool& pool, double ratio, double bound) {
  result.value = restricted.value();
  result.max_sensitivity_ratio = ratio;
  result.bound = bound;
  result.factor = restricted.factor();
  result.price = restricted.price();
  result.support.clear();
  for (const int place : restricted.candidates()) result.support.push_back(pool.candidate(place));
  result.weights.assign(restricted.weights().data(), restricted.weights().data() + restricted.weights().size());
}

}  // namespace

ApproximateDesign solve_spread_design(SpreadBlocks& candidates, const InformationFunction& function,
                                      const ApproximateDesignOptions& options, const Monitor& monitor) {
  const std::size_t n = candidates.count(), m = std::size_t(candidates.columns());
  const double degree = function.degree();
  const auto top = std::size_t(std::ceil(1 / options.cap - 1e-9));
  if (!(degree > 0) || n == 0 || top >= n || options.prior.size() > 0)
    throw std::invalid_argument("spread design: a criterion with a bound, more candidates than poses and no prior");
  const std::size_t room = std::max<std::size_t>(3 * m, 2 * top);

  Pool pool(candidates);
  RestrictedDesign restricted(pool.blocks(), function, options.cap, options.prior);
  const auto set = [&](const std::vector<int>& working) { return restricted.set_candidates(pool.places(working)); };
  for (std::size_t size = std::max<std::size_t>({6 * m, 4 * top, 50}); !set(first_working_set(candidates, size));
       size *= 4)
    if (size >= n)
      throw CannotDo("the parameters cannot be identified from these candidates: the information is singular");
  ApproximateDesign result;
  result.degree = degree;
  result.bound = std::numeric_limits<double>::infinity();
  double gap = 1.0;
  int unchanged = 0;
  // Where processes stop they stop together, between rounds; and a bound says something after the first.
  const Monitor unstopped;
  for (int round = 1;; ++round) {
    const Monitor& watch = round == 1 || several_processes(monitor) ? unstopped : monitor;
    result.newton_steps += restricted.solve(std::max(0.2 * options.tolerance, 0.03 * std::min(gap, 1.0)), watch);
    candidates.pass(restricted.factor());
    const double ratio = std::max(1.0, largest_mean(candidates, options.cap) / degree);
    const double bound = with_margin(restricted.value() + degree * std::log(ratio));
    gap = ratio - 1;
    monitor.report({"certificate", double(round), 0, {}, {}, std::exp(-(bound - restricted.value()) / degree)});
    if (bound <= result.bound) keep(result, restricted, pool, ratio, bound);
    result.rounds = round;
    result.stopped = candidates.stopped();
    const double tolerance =
        restricted.candidates().size() > most_settled ? std::max(options.tolerance, settled_gap) : options.tolerance;
    if (gap <= tolerance || round == options.max_rounds || result.stopped) break;
    std::vector<int> now;
    for (const int place : restricted.candidates()) now.push_back(pool.candidate(place));
    const std::vector<int> next = next_working_set(restricted, pool, candidates, std::min(n, 2 * top), room);
    // Nothing left to add: what remains is the accuracy of the weights, or rounding.
    if (next == now && ++unchanged > 3) break;
    if (!set(next)) break;
  }
  return result;
}

}  // namespace posewright
