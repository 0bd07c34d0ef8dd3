// NodeRelaxation for o3: bounds by a matrix E of trace 1, and what single rows must be like.

#include <algorithm>
#include <cmath>
#include <limits>

#include "node_relaxation.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// A step of the interior-point method costs the cube of the candidates.
constexpr std::size_t most_candidates = 500;
constexpr int most_eigenvalue_steps = 40;
// Groups of rows that exclude each other: each costs time and more of them settle little.
constexpr int most_groups = 2;
// Numbers nearer to a whole one count as that.
constexpr double whole_number = 1e-6;
// Numbers that reach what is needed end a relaxation once the bound is no more than so many times as far above them as
// they are above it, or this near to them: the box will be split anyway, and numbers well inside are the better ones to
// split it by.
constexpr double far_enough = 30.0, as_near = 1e-4;
// Prices of the limits that are tried around the program's own.
constexpr int most_prices = 3;
// What sums of the bound may be off by, generously.
constexpr double sum_rounding = 1e-13;
// Boxes are looked at once more where at least this share of their candidates is settled.
constexpr double settled_share = 0.1;

}  // namespace

/// Takes away rows that nothing better has; false if there are none.
bool NodeRelaxation::rule_out_rows(ChoiceBox& box) const {
  bool changed = false;
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const auto i = std::size_t(free_[f]);
    const int room = !inertia_.possible(Eigen::Index(f)) ? 0 : inertia_.slack() == 0 ? std::min(1, room_[f]) : room_[f];
    if (room == room_[f]) continue;
    box.most[i] = std::uint16_t(least_[f] + room);
    changed = true;
  }
  return changed;
}

/// Rows of which no more than a few are in anything better, as limits for the numbers.
void NodeRelaxation::limit_rows(const std::vector<double>& numbers) {
  const auto size = Eigen::Index(free_.size());
  const bool limited = single_rows() && inertia_.slack() >= 1 && inertia_.slack() < left_;
  limits_.weights.setZero(limited ? 1 + most_groups : 0, size);
  Eigen::Index count = 0;
  if (limited) {
    limits_.weights.row(count++) = inertia_.shortfall();
    for (Eigen::Index f = 0; f < size; ++f)
      open_numbers_[f] = numbers[std::size_t(free_[std::size_t(f)])] - least_[std::size_t(f)];
    group_room_ = scaled_room_;
    for (int group = 0; group < most_groups; ++group) {
      const std::vector<int>& exclusive = inertia_.exclusive(open_numbers_, group_room_);
      if (int(exclusive.size()) <= inertia_.slack()) break;
      for (const int f : exclusive) {
        limits_.weights(count, f) = 1.0;
        group_room_[f] = 0.0;
      }
      ++count;
    }
  }
  limits_.weights.conservativeResize(count, size);
  limits_.most.setConstant(count, inertia_.slack());
}

/// grant() for tr(J_i E J_iᵀ) less what the limits' weights cost, at the multiple of the program's prices that makes
/// the least of it: any is valid.
void NodeRelaxation::grant_within_limits() {
  const Eigen::VectorXd& shares = program_.shares();
  const Eigen::Index count = limits_.most.size();
  priced_.setZero(shares.size());
  double paid = 0.0;
  for (Eigen::Index k = 0; k < count; ++k) {
    priced_ += program_.prices()[k] * limits_.weights.row(k).transpose();
    paid += program_.prices()[k] * limits_.most[k];
  }
  double low = 0.0, high = 4.0, at = count > 0 ? 1.0 : 0.0, best_at = 0.0;
  double best = std::numeric_limits<double>::infinity();
  const auto grant_at = [&](double price) {
    d_ = shares - price * priced_;
    fixed_share_ = program_.known_share() + price * paid;
    grant();
  };
  for (int k = 0; k < (count > 0 ? most_prices : 1); ++k) {
    grant_at(at);
    if (most_possible_ < best) {
      best = most_possible_;
      best_at = at;
    }
    double used = 0.0;
    for (Eigen::Index f = 0; f < d_.size(); ++f) used += granted_[std::size_t(f)] * priced_[f];
    (used > paid ? low : high) = at;
    at = 0.5 * (low + high);
  }
  grant_at(best_at);
  double size = std::abs(fixed_share_);
  for (Eigen::Index f = 0; f < d_.size(); ++f) size += granted_[std::size_t(f)] * std::abs(d_[f]);
  most_possible_ += sum_rounding * double(m_) * size;
}

/// Steps of the program until the box is ruled out or sure to be split.
void NodeRelaxation::lower_bound_of_least(RelaxedBox& relaxed, double best) {
  const double target = needed(best);
  double lowest = std::numeric_limits<double>::infinity();
  for (int step = 0; step < most_eigenvalue_steps; ++step) {
    grant_within_limits();
    if (most_possible_ < lowest) {
      lowest = most_possible_;
      tightest_ = d_;
      tightest_share_ = fixed_share_;
    }
    if (lowest <= target) break;
    const double gap = lowest - program_.reached();
    if (gap < as_near * lowest) break;
    if (gap < far_enough * (program_.reached() - target) && program_.within_limits()) break;
    if (!program_.step()) break;
  }
  if (most_possible_ > lowest) {
    d_ = tightest_;
    fixed_share_ = tightest_share_;
    grant();
    most_possible_ = std::max(most_possible_, lowest);
  }
  relaxed.bound = lowest > 0 ? 0.5 * std::log(lowest) : -std::numeric_limits<double>::infinity();
}

/// The candidate whose number is most of the way to the next whole one and counts most in tr(E M): chosen, it leaves
/// fewer rows to choose, of which more is known; left out, the bound falls most. Rows that lift no eigenvalue are
/// chosen later.
int NodeRelaxation::branching_by_number(const ChoiceBox& box, const std::vector<double>& numbers) const {
  int chosen = -1;
  double most = 0.0;
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const auto i = std::size_t(free_[f]);
    if (box.most[i] == box.least[i]) continue;
    const double part = numbers[i] - std::floor(numbers[i]);
    if (part <= whole_number) continue;
    const double shortfall = single_rows() ? inertia_.shortfall()[Eigen::Index(f)] : 0.0;
    const double score = part * program_.shares()[Eigen::Index(f)] * (1 - 0.5 * shortfall);
    if (score <= most) continue;
    most = score;
    chosen = int(i);
  }
  return chosen;
}

std::optional<bool> NodeRelaxation::solve_least_eigenvalue(ChoiceBox& box, RelaxedBox& relaxed, double best) {
  of_least_eigenvalue_ = false;
  if (least_eigenvalue_ == nullptr || free_.size() > most_candidates) return std::nullopt;
  const Eigen::MatrixXd& C = least_eigenvalue_->to_scaled();
  scaled_rows_.noalias() = rows_ * C;
  scaled_known_ = C.transpose() * fixed_ * C;
  const auto size = Eigen::Index(free_.size());
  scaled_room_.resize(size);
  open_numbers_.resize(size);
  for (Eigen::Index f = 0; f < size; ++f) scaled_room_[f] = room_[std::size_t(f)];
  of_least_eigenvalue_ = true;
  if (single_rows()) {
    if (!inertia_.look(scaled_known_, scaled_rows_, scaled_room_, left_, needed(best))) return false;
    if (rule_out_rows(box)) return true;
  }
  limit_rows(relaxed.numbers);
  for (Eigen::Index f = 0; f < size; ++f)
    open_numbers_[f] = relaxed.numbers[std::size_t(free_[std::size_t(f)])] - least_[std::size_t(f)];
  if (!program_.begin(scaled_rows_, scaled_known_, scaled_room_, limits_, open_numbers_)) {
    of_least_eigenvalue_ = false;
    return std::nullopt;
  }
  lower_bound_of_least(relaxed, best);
  if (relaxed.bound <= best) return false;
  for (Eigen::Index f = 0; f < size; ++f)
    relaxed.numbers[std::size_t(free_[std::size_t(f)])] = least_[std::size_t(f)] + program_.numbers()[f];
  if (tighten(box, best)) {
    int settled = 0, forced = 0;
    for (std::size_t f = 0; f < free_.size(); ++f) {
      const auto i = std::size_t(free_[f]);
      settled += box.most[i] == box.least[i];
      forced += box.least[i] > least_[f];
    }
    if (forced > 0 || settled >= settled_share * double(free_.size())) return true;
  }
  relaxed.branch = branching_by_number(box, relaxed.numbers);
  return true;
}

}  // namespace posewright
