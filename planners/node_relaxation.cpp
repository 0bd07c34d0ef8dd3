#include "node_relaxation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "posewright/criterion/determinant.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// Numbers nearer to a limit than this are at it.
constexpr double at_limit = 1e-7;
// A bound this near the value ends a relaxation that will be branched on anyway.
constexpr double near_enough = 1e-7;
// Ridge of the bound that knows the rank, in log det.
constexpr double acceptable_looseness = 1e-6;
constexpr int most_steps = 40, most_pivots = 15;

const SpectralFunction* least_eigenvalue(const InformationFunction& function) {
  const auto* spectral = dynamic_cast<const SpectralFunction*>(&function);
  return spectral != nullptr && spectral->index() == SpectralIndex::o3 ? spectral : nullptr;
}

}  // namespace

NodeRelaxation::NodeRelaxation(const DesignTask& task)
    : task_(task),
      blocks_(*task.candidates.blocks),
      function_(task.criterion->function()),
      least_eigenvalue_(least_eigenvalue(function_)),
      r_(blocks_.rows()),
      m_(blocks_.columns()),
      log_det_(dynamic_cast<const LogDetFunction*>(&function_) != nullptr && function_.degree() == m_),
      program_(r_, least_eigenvalue_ != nullptr ? least_eigenvalue_->nuisance() : 0) {}

void NodeRelaxation::gather(const ChoiceBox& box) {
  fixed_ = task_.candidates.prior != nullptr ? *task_.candidates.prior : Eigen::MatrixXd::Zero(m_, m_);
  free_.clear();
  least_.clear();
  room_.clear();
  left_ = task_.poses;
  for (std::size_t i = 0; i < box.least.size(); ++i) {
    if (box.least[i] > 0) {
      fixed_.noalias() += double(box.least[i]) * blocks_.block(i).transpose() * blocks_.block(i);
      left_ -= box.least[i];
    }
    if (box.most[i] == box.least[i]) continue;
    free_.push_back(int(i));
    least_.push_back(box.least[i]);
    room_.push_back(box.most[i] - box.least[i]);
  }
  rows_.resize(Eigen::Index(free_.size()) * r_, m_);
  for (std::size_t f = 0; f < free_.size(); ++f)
    rows_.middleRows(Eigen::Index(f) * r_, r_) = blocks_.block(std::size_t(free_[f]));
}

/// Clips the numbers to the box and spreads what is missing, or too much, over those that are between their limits
/// (over all, if those do not suffice). `numbers` of the free candidates is what exceeds `least` afterwards.
bool NodeRelaxation::make_feasible(const ChoiceBox& box, std::vector<double>& numbers) const {
  const int room = std::accumulate(room_.begin(), room_.end(), 0);
  if (left_ < 0 || room < left_) return false;
  std::vector<double> open(free_.size());
  double sum = 0.0;
  for (std::size_t f = 0; f < free_.size(); ++f) {
    open[f] = std::clamp(numbers[std::size_t(free_[f])] - least_[f], 0.0, double(room_[f]));
    sum += open[f];
  }
  if (sum > left_) {
    for (double& x : open) x *= left_ / sum;
  } else if (sum < left_) {
    double partial = 0.0, whole = 0.0;
    for (std::size_t f = 0; f < free_.size(); ++f) {
      whole += room_[f] - open[f];
      if (open[f] > at_limit) partial += room_[f] - open[f];
    }
    const bool partly = partial > 2 * (left_ - sum);
    const double share = (left_ - sum) / (partly ? partial : whole);
    for (std::size_t f = 0; f < free_.size(); ++f)
      if (!partly || open[f] > at_limit) open[f] += share * (room_[f] - open[f]);
  }
  for (std::size_t i = 0; i < box.least.size(); ++i) numbers[i] = box.least[i];
  for (std::size_t f = 0; f < free_.size(); ++f) numbers[std::size_t(free_[f])] += open[f];
  return true;
}

void NodeRelaxation::add_information(const std::vector<double>& numbers) {
  information_ = fixed_;
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const double open = numbers[std::size_t(free_[f])] - least_[f];
    if (open <= 0.0) continue;
    const auto J = rows_.middleRows(Eigen::Index(f) * r_, r_);
    information_.noalias() += open * J.transpose() * J;
  }
}

std::unique_ptr<Expansion> NodeRelaxation::expand_at(const Eigen::MatrixXd& information) const {
  return limited_ != nullptr ? limited_->expand(information - fixed_) : function_.expand(information);
}

void NodeRelaxation::find_sensitivities(const std::vector<double>& numbers) {
  projected_.noalias() = rows_ * expansion_->factor;
  d_.resize(Eigen::Index(free_.size()));
  open_share_ = 0.0;
  for (Eigen::Index f = 0; f < d_.size(); ++f) {
    d_[f] = projected_.middleRows(f * r_, r_).squaredNorm();
    open_share_ += (numbers[std::size_t(free_[std::size_t(f)])] - least_[std::size_t(f)]) * d_[f];
  }
  fixed_share_ = limited_ != nullptr ? 0.0 : (expansion_->factor.transpose() * fixed_ * expansion_->factor).trace();
}

void NodeRelaxation::limit_rank() {
  if (!log_det_ || limited_ != nullptr || left_ * r_ >= m_) return;
  const double ridge = acceptable_looseness / expansion_->factor.squaredNorm();
  limited_ = std::make_unique<RankLimitedLogDet>(fixed_, ridge, left_ * r_);
  expansion_ = expand_at(information_);
}

/// The numbers, mixed with an even choice where they alone leave a parameter unknown; false if that does too.
bool NodeRelaxation::start_regular(const ChoiceBox& box, std::vector<double>& numbers) {
  add_information(numbers);
  expansion_ = function_.expand(information_);
  if (expansion_ != nullptr) return true;
  const double room = std::accumulate(room_.begin(), room_.end(), 0.0);
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const auto i = std::size_t(free_[f]);
    numbers[i] = box.least[i] + 0.9 * (numbers[i] - box.least[i]) + 0.1 * room_[f] * left_ / room;
  }
  add_information(numbers);
  expansion_ = function_.expand(information_);
  return expansion_ != nullptr;
}

void NodeRelaxation::grant() {
  order_.resize(free_.size());
  std::iota(order_.begin(), order_.end(), 0);
  granted_.assign(free_.size(), 0);
  // No more than left_ of them count.
  const auto count = std::min(order_.size(), std::size_t(left_) + 1);
  std::partial_sort(order_.begin(), order_.begin() + std::ptrdiff_t(count), order_.end(),
                    [&](int a, int b) { return d_[a] > d_[b] || (d_[a] == d_[b] && a < b); });
  int left = left_;
  most_possible_ = fixed_share_;
  weakest_ = next_ = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto f = std::size_t(order_[k]);
    if (left == 0) {
      next_ = d_[Eigen::Index(f)];
      break;
    }
    const int taken = std::min(left, room_[f]);
    granted_[f] = taken;
    left -= taken;
    most_possible_ += taken * d_[Eigen::Index(f)];
    weakest_ = next_ = d_[Eigen::Index(f)];
    if (left == 0 && taken < room_[f]) break;
  }
}

double NodeRelaxation::bound() {
  grant();
  const double h = function_.degree();
  return expansion_->value + (limited_ != nullptr ? most_possible_ - open_share_ : h * std::log(most_possible_ / h));
}

double NodeRelaxation::needed(double best) const {
  if (of_least_eigenvalue_) return std::exp(2 * best);
  const double h = function_.degree();
  return limited_ != nullptr ? best - expansion_->value + open_share_ : h * std::exp((best - expansion_->value) / h);
}

/// Candidates between their limits, and those at a limit that they would gain by leaving.
void NodeRelaxation::choose_working_set(const std::vector<double>& numbers) {
  working_.clear();
  double price = 0.0;
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const double open = numbers[std::size_t(free_[f])] - least_[f];
    if (open <= at_limit || open >= room_[f] - at_limit) continue;
    working_.push_back(int(f));
    price += d_[Eigen::Index(f)];
  }
  price = working_.empty() ? 0.5 * (weakest_ + next_) : price / double(working_.size());
  std::vector<std::pair<double, int>> leaving;
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const double open = numbers[std::size_t(free_[f])] - least_[f], d = d_[Eigen::Index(f)];
    if (open <= at_limit && d > price) leaving.emplace_back(price - d, int(f));
    else if (open >= room_[f] - at_limit && d < price) leaving.emplace_back(d - price, int(f));
  }
  const auto kept = std::min(leaving.size(), std::size_t(m_) + 5);
  std::partial_sort(leaving.begin(), leaving.begin() + std::ptrdiff_t(kept), leaving.end());
  for (std::size_t k = 0; k < kept; ++k) working_.push_back(leaving[k].second);
}

void NodeRelaxation::copy_working_rows() {
  working_rows_.resize(Eigen::Index(working_.size()) * r_, m_);
  for (std::size_t w = 0; w < working_.size(); ++w)
    working_rows_.middleRows(Eigen::Index(w) * r_, r_) = rows_.middleRows(Eigen::Index(working_[w]) * r_, r_);
  expansion_->curvature(working_rows_, r_, curvature_);
  curvature_.diagonal().array() += 1e-10 * curvature_.diagonal().mean();
}

/// The change that the quadratic model of Φ likes best within the limits: a primal-dual active set method
/// (Hintermüller, Ito & Kunisch 2003).
void NodeRelaxation::solve_quadratic(const std::vector<double>& numbers) {
  const auto s = Eigen::Index(working_.size());
  Eigen::VectorXd low(s), high(s), d(s);
  for (Eigen::Index w = 0; w < s; ++w) {
    const auto f = std::size_t(working_[std::size_t(w)]);
    const double open = numbers[std::size_t(free_[f])] - least_[f];
    low[w] = -open;
    high[w] = room_[f] - open;
    d[w] = d_[Eigen::Index(f)];
  }
  std::vector<int> side(std::size_t(s), 0);  // −1, +1: held at a limit
  change_ = Eigen::VectorXd::Zero(s);
  Eigen::LLT<Eigen::MatrixXd> factor;
  for (int pivot = 0; pivot < most_pivots; ++pivot) {
    std::vector<int> open;
    double held = 0.0;
    for (Eigen::Index w = 0; w < s; ++w) {
      const int where = side[std::size_t(w)];
      if (where == 0) open.push_back(int(w));
      else change_[w] = where < 0 ? low[w] : high[w], held += change_[w];
    }
    if (open.empty()) break;
    for (const int w : open) change_[w] = 0.0;
    const Eigen::MatrixXd H = curvature_(open, open);
    const Eigen::VectorXd force = d - curvature_ * change_;
    factor.compute(H);
    const Eigen::VectorXd a = factor.solve(force(open)), b = factor.solve(Eigen::VectorXd::Ones(H.rows()));
    const double price = (a.sum() + held) / b.sum();
    for (std::size_t k = 0; k < open.size(); ++k) change_[open[k]] = a[Eigen::Index(k)] - price * b[Eigen::Index(k)];
    const Eigen::VectorXd pull = (d - curvature_ * change_).array() - price;
    bool changed = false;
    for (Eigen::Index w = 0; w < s; ++w) {
      int& where = side[std::size_t(w)];
      int wanted = where;
      if (where == 0 && change_[w] < low[w] - at_limit) wanted = -1;
      else if (where == 0 && change_[w] > high[w] + at_limit) wanted = 1;
      else if (where * pull[w] < 0) wanted = 0;
      changed |= wanted != where;
      where = wanted;
    }
    if (!changed) break;
  }
  double longest = 1.0;
  for (Eigen::Index w = 0; w < s; ++w) {
    if (change_[w] < low[w]) longest = std::min(longest, low[w] / change_[w]);
    if (change_[w] > high[w]) longest = std::min(longest, high[w] / change_[w]);
  }
  change_ *= std::max(0.0, longest);
}

/// One step of sequential quadratic programming, or, where that gains nothing, towards the best that the sensitivities
/// alone promise (Frank & Wolfe 1956); false if neither gains.
bool NodeRelaxation::step(std::vector<double>& numbers) {
  choose_working_set(numbers);
  if (working_.size() >= 2) {
    copy_working_rows();
    solve_quadratic(numbers);
    if (search_along(numbers)) return true;
  }
  working_.resize(free_.size());
  std::iota(working_.begin(), working_.end(), 0);
  change_.resize(Eigen::Index(free_.size()));
  for (std::size_t f = 0; f < free_.size(); ++f)
    change_[Eigen::Index(f)] = granted_[f] - (numbers[std::size_t(free_[f])] - least_[f]);
  return search_along(numbers);
}

/// Moves the working candidates' numbers by change_, or a part of it; false if no part gains.
bool NodeRelaxation::search_along(std::vector<double>& numbers) {
  double promised = 0.0;
  for (std::size_t w = 0; w < working_.size(); ++w) promised += change_[Eigen::Index(w)] * d_[working_[w]];
  if (!(promised > 1e-12)) return false;
  const double before = expansion_->value;
  std::vector<double> tried = numbers;
  for (double t = 1.0; t > 1e-3; t *= 0.5) {
    for (std::size_t w = 0; w < working_.size(); ++w) {
      const auto f = std::size_t(working_[w]);
      const auto i = std::size_t(free_[f]);
      tried[i] = std::clamp(numbers[i] + t * change_[Eigen::Index(w)], double(least_[f]), double(least_[f] + room_[f]));
    }
    add_information(tried);
    auto there = expand_at(information_);
    if (there == nullptr || there->value < before + 0.1 * t * promised * (1 - t)) continue;
    if (there->value <= before) return false;
    expansion_ = std::move(there);
    numbers = tried;
    return true;
  }
  return false;
}

/// Anything better than the best has fixed_share + Σ n_i d_i of at least `needed`: one more of a candidate below the
/// weakest granted takes a place from one at least as good as that, one fewer gives its place to the next at most.
bool NodeRelaxation::tighten(ChoiceBox& box, double best) const {
  const double slack = most_possible_ - needed(best);
  bool tightened = false;
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const double d = d_[Eigen::Index(f)];
    const auto i = std::size_t(free_[f]);
    if (granted_[f] < room_[f] && weakest_ > d) {
      const double more = std::floor(slack / (weakest_ - d));
      if (granted_[f] + more < room_[f]) {
        box.most[i] = std::uint16_t(least_[f] + granted_[f] + int(more));
        tightened = true;
      }
    }
    if (granted_[f] > 0 && d > next_) {
      const double fewer = std::floor(slack / (d - next_));
      if (granted_[f] - fewer > 0) {
        box.least[i] = std::uint16_t(least_[f] + granted_[f] - int(fewer));
        tightened = true;
      }
    }
  }
  return tightened;
}

/// The candidate whose two sides lose most, by the curvature among those that are between whole numbers: moving n_i by
/// δ costs δ²/(2 K_ii), K being the inverse curvature under Σ n = N.
int NodeRelaxation::branching_candidate(const std::vector<double>& numbers) {
  working_.clear();
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const double x = numbers[std::size_t(free_[f])];
    if (std::abs(x - std::round(x)) > 1e-6) working_.push_back(int(f));
  }
  if (working_.empty()) return -1;
  if (working_.size() == 1) return free_[std::size_t(working_[0])];
  copy_working_rows();
  const Eigen::LLT<Eigen::MatrixXd> factor(curvature_);
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(curvature_.rows(), curvature_.rows()));
  const Eigen::VectorXd b = inverse.rowwise().sum();
  int chosen = -1;
  double most = -1.0;
  for (std::size_t w = 0; w < working_.size(); ++w) {
    const double x = numbers[std::size_t(free_[std::size_t(working_[w])])], down = x - std::floor(x), up = 1 - down;
    const auto k = Eigen::Index(w);
    const double K = std::max(inverse(k, k) - b[k] * b[k] / b.sum(), 1e-12);
    const double score = down * down * up * up / (K * K);
    if (score > most) {
      most = score;
      chosen = free_[std::size_t(working_[w])];
    }
  }
  return chosen;
}

bool NodeRelaxation::solve(ChoiceBox& box, RelaxedBox& relaxed, double best) {
  gather(box);
  limited_.reset();
  relaxed.branch = -1;
  if (!make_feasible(box, relaxed.numbers)) return false;
  if (const auto kept = solve_least_eigenvalue(box, relaxed, best)) return *kept;
  if (!start_regular(box, relaxed.numbers)) return false;
  relaxed.bound = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_steps; ++round) {
    find_sensitivities(relaxed.numbers);
    relaxed.bound = std::min(relaxed.bound, bound());
    if (relaxed.bound <= best) return false;
    if (round == 0) {
      limit_rank();
      if (limited_ != nullptr) continue;
    }
    const double gap = relaxed.bound - expansion_->value;
    if (gap < near_enough || gap < 0.02 * (expansion_->value - best)) break;
    if (!step(relaxed.numbers)) break;
  }
  if (tighten(box, best)) return true;
  relaxed.branch = branching_candidate(relaxed.numbers);
  return true;
}

}  // namespace posewright
