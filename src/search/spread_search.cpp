#include "posewright/search/spread_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "planners/local_search.hpp"
#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/share_state.hpp"
#include "posewright/search/design_measure.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"
#include "spread_candidates.hpp"

namespace posewright {
namespace {

using Traffic = Workers::Traffic;

/// The best exchange that a process found, or all of them, and whether one was told to stop.
struct Found {
  double gain = 0.0;
  std::int64_t candidate = -1;
  bool stop = false;

  static auto fields(auto& own) { return std::tie(own.gain, own.candidate, own.stop); }
};

std::string better(std::string_view lower, std::string_view higher) {
  auto a = value_in<Found>(lower), b = value_in<Found>(higher);
  const bool stop = a.stop || b.stop;
  // Lower ranks have lower candidates: of equal gains the first counts.
  if (a.candidate < 0 || (b.candidate >= 0 && b.gain > a.gain)) a = b;
  a.stop = stop;
  return bytes_of(a);
}

void count(Traffic& traffic, const Traffic& before, const Traffic& after) {
  traffic.messages += after.messages - before.messages;
  traffic.bytes += after.bytes - before.bytes;
}

/// A start of the search and where it goes; all processes do the same.
class SpreadDesign {
 public:
  /// @param offset  what is added to Φ for messages
  /// @param so_far  the best Φ of earlier starts, for progress
  SpreadDesign(SpreadCandidates& candidates, const SpreadRequest& request, double offset, double so_far,
               const Monitor& monitor, SpreadTraffic& traffic)
      : candidates_(candidates),
        request_(request),
        offset_(offset),
        so_far_(so_far),
        monitor_(monitor),
        traffic_(traffic),
        state_(candidates.own(), candidates.own_count(), request.poses, thread_count(candidates.threads())) {}

  void begin(const std::vector<int>& members) {
    for (const int candidate : members) {
      take_up(candidate);
      state_.put(block_.data());
    }
    state_.refresh();
  }

  /// One pose after the other until there are enough; a stop does not end this.
  void fill() {
    while (state_.size() < request_.poses) {
      const Found found = agree(state_.best_addition());
      if (found.candidate < 0) throw CannotDo("the candidates do not suffice for so many poses");
      take_up(int(found.candidate));
      state_.add(block_.data());
    }
    state_.refresh();
  }

  /// As settle() of planners/local_search.cpp, with the best exchange over all processes.
  void settle() {
    int singular = 0;
    while (true) {
      int accepted = 0, now = 0;
      do {
        now = pass();
        accepted += now;
        if (!std::isfinite(state_.value()) && ++singular >= most_singular_passes) break;
      } while (now > 0 && !stopped_);
      state_.refresh();
      if (accepted == 0 || singular >= most_singular_passes || stopped_) return;
    }
  }

  double value() const { return state_.value(); }
  long exchanges() const { return exchanges_; }
  bool stopped() const { return stopped_; }
  /// The members, ascending, and their whitened blocks.
  void take(std::vector<int>& members, BlockArray& blocks) const {
    std::vector<int> order(members_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return members_[std::size_t(a)] < members_[std::size_t(b)]; });
    members.clear();
    blocks = BlockArray(order.size(), candidates_.rows(), candidates_.columns());
    for (std::size_t i = 0; i < order.size(); ++i) {
      members.push_back(members_[std::size_t(order[i])]);
      std::copy_n(state_.member(order[i]), length(), blocks.row(i, 0));
    }
  }

 private:
  static constexpr int most_singular_passes = 50;

  std::size_t length() const { return std::size_t(candidates_.rows()) * std::size_t(candidates_.own().stride()); }

  /// The best of what all processes found.
  Found agree(const Swap& own) {
    Found found{own.gain, own.enter < 0 ? -1 : candidates_.first() + own.enter, monitor_.should_stop()};
    std::string bytes = bytes_of(found);
    const Traffic before = candidates_.workers().own_traffic();
    candidates_.workers().combine(bytes, better);
    count(traffic_.most_of_looks, before, candidates_.workers().own_traffic());
    ++traffic_.looks;
    traffic_.look_bytes = long(bytes.size());
    found = value_in<Found>(bytes);
    stopped_ = stopped_ || found.stop;
    return found;
  }

  /// A candidate's block, from the process that holds it.
  void fetch(int candidate) {
    std::string bytes;
    if (candidates_.has(candidate)) {
      const double* const block = candidates_.own().row(std::size_t(candidate - candidates_.first()), 0);
      bytes.assign(reinterpret_cast<const char*>(block), length() * sizeof(double));
    }
    const Traffic before = candidates_.workers().own_traffic();
    candidates_.workers().share_from(candidates_.owner(candidate), bytes);
    count(traffic_.most_of_blocks, before, candidates_.workers().own_traffic());
    ++traffic_.blocks;
    traffic_.block_bytes = long(bytes.size());
    block_.resize(length());
    std::copy_n(bytes.data(), bytes.size(), reinterpret_cast<char*>(block_.data()));
  }

  /// A new member, whose block is fetched.
  void take_up(int candidate) {
    fetch(candidate);
    members_.push_back(candidate);
    count_use(candidate, 1);
  }

  void count_use(int candidate, int change) {
    const int used = used_[candidate] += change;
    if (candidates_.has(candidate)) state_.block(candidate - candidates_.first(), used >= request_.repeats.most);
  }

  /// Every member once, the one that Φ misses least first. Of a start that is no plan yet the first pass is a whole
  /// one.
  int pass() {
    std::vector<int> order(members_.size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<double> loss(order.size());
    for (const int position : order) loss[std::size_t(position)] = state_.loss(position);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return loss[std::size_t(a)] < loss[std::size_t(b)]; });
    const bool whole = std::exchange(first_pass_, false) && !std::isfinite(state_.value());
    int accepted = 0;
    for (const int position : order) {
      if (!whole && stopped_) break;
      const int leaving = members_[std::size_t(position)];
      // The member itself would be no exchange.
      const bool mine = candidates_.has(leaving);
      if (mine) state_.block(leaving - candidates_.first(), true);
      const Found found = agree(state_.best_swap(position, smallest_gain));
      if (mine) state_.block(leaving - candidates_.first(), used_[leaving] >= request_.repeats.most);
      if (found.candidate < 0) continue;
      fetch(int(found.candidate));
      state_.replace(position, block_.data());
      members_[std::size_t(position)] = int(found.candidate);
      count_use(leaving, -1);
      count_use(int(found.candidate), 1);
      ++accepted;
    }
    exchanges_ += accepted;
    monitor_.report({"exchange", double(exchanges_), 0, std::max(state_.value(), so_far_) + offset_, {}, {}});
    return accepted;
  }

  SpreadCandidates& candidates_;
  const SpreadRequest& request_;
  double offset_, so_far_;
  const Monitor& monitor_;
  SpreadTraffic& traffic_;
  ShareState state_;
  std::vector<int> members_;
  std::map<int, int> used_;
  std::vector<double> block_;
  long exchanges_ = 0;
  bool stopped_ = false, first_pass_ = true;
};

/// The candidates of largest weight, as often as N·w says: a start, maybe of fewer than N.
std::vector<int> rounded(const ApproximateDesign& weights, const SpreadRequest& request) {
  std::vector<std::size_t> order(weights.support.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::vector<int> members;
  const auto left = [&](std::size_t i) {
    const double copies = weights.weights[i] * request.poses * (1 + 1e-9);
    return copies - std::floor(copies);
  };
  const auto add = [&](std::size_t i) {
    const int candidate = weights.support[i];
    if (int(members.size()) < request.poses &&
        std::count(members.begin(), members.end(), candidate) < request.repeats.most)
      members.push_back(candidate);
  };
  for (const std::size_t i : order)
    for (int k = int(std::floor(weights.weights[i] * request.poses * (1 + 1e-9))); k > 0; --k) add(i);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return left(a) > left(b); });
  for (const std::size_t i : order) add(i);
  return members;
}

/// Work of the busiest process, sent to all.
void most(Traffic& traffic, Workers& workers) {
  std::string bytes = bytes_of(traffic);
  workers.combine(bytes, [&](std::string_view lower, std::string_view higher) {
    const auto a = value_in<Traffic>(lower), b = value_in<Traffic>(higher);
    return bytes_of(Traffic{std::max(a.messages, b.messages), std::max(a.bytes, b.bytes)});
  });
  traffic = value_in<Traffic>(bytes);
}

/// The better local optimum of two starts; whitened blocks of its members in `chosen`.
Design best_design(SpreadCandidates& candidates, const SpreadRequest& request, const ApproximateDesign& weights,
                   double offset, const Monitor& monitor, SpreadTraffic& traffic, BlockArray& chosen) {
  Design best;
  best.value = -std::numeric_limits<double>::infinity();
  const bool greedy = request.method == "greedy";
  for (const bool by_weights : {true, false}) {
    if ((by_weights && greedy) || best.stopped) continue;
    SpreadDesign design(candidates, request, offset, best.value, monitor, traffic);
    if (by_weights) design.begin(rounded(weights, request));
    design.fill();
    if (!greedy) design.settle();
    ++best.restarts;
    best.exchanges += design.exchanges();
    best.stopped = design.stopped();
    if (!(design.value() > best.value + smallest_gain)) continue;
    best.value = design.value();
    design.take(best.members, chosen);
  }
  if (best.members.empty())
    throw CannotDo("no set of " + std::to_string(request.poses) +
                   " candidates was found that identifies all parameters");
  return best;
}

void fill(Certificate& certificate, const ApproximateDesign& weights, const SpreadRequest& request, double offset,
          std::size_t candidates) {
  certificate.bound = weights.bound_for(request.poses) + offset;
  certificate.max_sensitivity_ratio = weights.max_sensitivity_ratio;
  certificate.count = candidates;
  certificate.repeats = repeats_text(request.repeats);
}

/// Φ without each member.
std::vector<double> kept_without_each(const BlockArray& chosen, const LogDetFunction& function) {
  const Eigen::MatrixXd M = chosen.all().transpose() * chosen.all();
  const double whole = function.value(M);
  std::vector<double> result;
  for (std::size_t i = 0; i < chosen.count(); ++i) {
    const auto block = chosen.block(i);
    const double rest = function.value(M - block.transpose() * block);
    result.push_back(std::min(1.0, std::exp((rest - whole) / function.degree())));
  }
  return result;
}

}  // namespace

SearchResult search_spread(BlockShare share, const SpreadRequest& request, Workers& workers, const Monitor& monitor,
                           SpreadTraffic& traffic) {
  SpreadCandidates candidates(std::move(share), workers, thread_count(request.threads), monitor);
  const Whitening whitening = candidates.whitened();
  const auto criterion = std::make_shared<DeterminantCriterion>("o1", 0, candidates.columns());
  const LogDetFunction function(0, candidates.columns());
  const double offset = whitening.log_det_offset(0);
  ApproximateDesignOptions options;
  options.cap = std::min(1.0, double(request.repeats.most) / request.poses);
  const ApproximateDesign weights = solve_spread_design(candidates, function, options, monitor);

  SearchResult result;
  BlockArray chosen;
  result.design = best_design(candidates, request, weights, offset, monitor, traffic, chosen);
  result.design.value = function.value(chosen.all().transpose() * chosen.all());
  result.stopped = weights.stopped || result.design.stopped;
  result.measure = std::make_shared<DesignMeasure>(criterion, whitening.R, Eigen::MatrixXd(), offset);
  result.degree = function.degree();
  fill(result.certificate, weights, request, offset, candidates.count());
  result.without = kept_without_each(chosen, function);
  for (std::size_t i = 0; i < chosen.count(); ++i) chosen.block(i) = (chosen.block(i) * whitening.R).eval();
  result.chosen.push_back(std::move(chosen));
  most(traffic.most_of_looks, workers);
  most(traffic.most_of_blocks, workers);
  return result;
}

}  // namespace posewright
