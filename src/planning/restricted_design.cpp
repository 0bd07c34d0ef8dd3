#include "restricted_design.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "posewright/planning/approximate_design.hpp"
#include "posewright/planning/step_to_boundary.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr int max_newton_steps = 80;
constexpr int max_halvings = 20;
// Fraction of the way to the boundary that a step may go.
constexpr double boundary_fraction = 0.995;
// Each step aims at this share of the present products weight × multiplier.
constexpr double centring = 0.1;

/// Solver of (D + H) x = b, D diagonal and positive, H Φ's curvature on the stacked blocks.
class NewtonSystem {
 public:
  /// @param H  room for a dense curvature; used if the curvature has no factor with few columns
  NewtonSystem(const Expansion& expansion, const BlockArray::RowMatrix& rows, int r, const Eigen::ArrayXd& D,
               Eigen::MatrixXd& H)
      : D_(D), U_(expansion.curvature_factor(rows, r, D.size() / 2)) {
    if (U_.size() == 0) {
      expansion.curvature(rows, r, H);
      H.diagonal() += D.matrix();
      // In place: of thousands of candidates a second copy would be the largest thing in memory.
      dense_.emplace(H);
      return;
    }
    // Woodbury: (D + UUᵀ)⁻¹ = D⁻¹ − D⁻¹U (I + UᵀD⁻¹U)⁻¹ UᵀD⁻¹.
    const BlockArray::RowMatrix scaled = D.rsqrt().matrix().asDiagonal() * U_;
    Eigen::MatrixXd inner = Eigen::MatrixXd::Identity(U_.cols(), U_.cols());
    inner.selfadjointView<Eigen::Lower>().rankUpdate(scaled.transpose());
    inner_.compute(inner);
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& b) const {
    if (dense_) return dense_->solve(b);
    const Eigen::VectorXd x = once(b);
    // D spans many orders of magnitude near the end: one refinement takes back what that rounds off.
    return x + once(b - D_.matrix().cwiseProduct(x) - U_ * (U_.transpose() * x));
  }

 private:
  Eigen::VectorXd once(const Eigen::VectorXd& b) const {
    const Eigen::VectorXd scaled = b.array() / D_;
    return scaled - ((U_ * inner_.solve(U_.transpose() * scaled)).array() / D_).matrix();
  }

  const Eigen::ArrayXd& D_;
  BlockArray::RowMatrix U_;
  Eigen::LLT<Eigen::MatrixXd> inner_;
  std::optional<Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>> dense_;
};

}  // namespace

double best_mean(std::vector<double> value, double cap) {
  const auto whole = std::min(std::size_t(std::floor(1 / cap + 1e-9)), value.size());
  const bool part = whole < value.size() && 1 - double(whole) * cap > 1e-12;
  const auto count = std::ptrdiff_t(whole + (part ? 1 : 0));
  std::nth_element(value.begin(), value.begin() + count - 1, value.end(), std::greater<>());
  // In the order that each standard library leaves, the sum's last digits would be its own.
  std::sort(value.begin(), value.begin() + count, std::greater<>());
  const double sum = std::accumulate(value.begin(), value.begin() + std::ptrdiff_t(whole), 0.0);
  if (!part) return sum / double(whole);
  return cap * sum + (1 - double(whole) * cap) * value[whole];
}

std::vector<int> with_drawn(std::vector<int> strong, std::size_t n, std::size_t size) {
  std::vector<int> set = std::move(strong);
  Random random(0, size);
  const std::size_t drawn = size - size / 2;
  const double stretch = double(n) / double(drawn);
  for (std::size_t i = 0; i < drawn; ++i)
    set.push_back(std::min(int(n) - 1, int(stretch * (double(i) + random.uniform()))));
  std::sort(set.begin(), set.end());
  set.erase(std::unique(set.begin(), set.end()), set.end());
  return set;
}

double with_margin(double bound) {
  return bound + 1e3 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(bound));
}

RestrictedDesign::RestrictedDesign(const BlockArray& blocks, const InformationFunction& function, double cap,
                                   const Eigen::MatrixXd& prior)
    : blocks_(blocks), function_(function), degree_(function.degree()), cap_(cap), prior_(prior) {}

bool RestrictedDesign::set_candidates(const std::vector<int>& candidates) {
  std::unordered_map<int, double> old;
  for (std::size_t i = 0; i < candidates_.size(); ++i) old[candidates_[i]] = w_[Eigen::Index(i)];
  candidates_ = candidates;
  const auto s = Eigen::Index(candidates.size());
  // A tenth of the mean weight for newcomers lets them grow; keeping everybody off the bounds lets the method move.
  const double uniform = 1.0 / double(s);
  Eigen::VectorXd start = Eigen::VectorXd::Constant(s, old.empty() ? uniform : 0.1 * uniform);
  for (Eigen::Index i = 0; i < s; ++i) {
    const auto found = old.find(candidates[std::size_t(i)]);
    if (found != old.end()) start[i] = std::max(found->second, 0.01 * uniform);
  }
  start /= start.sum();
  // Mixing with uniform weights leaves room below the cap and keeps the sum.
  if (capped()) {
    const double target = std::max(0.9 * cap_, 0.5 * (cap_ + uniform)), most = start.maxCoeff();
    const double mix = most > target ? (most - target) / (most - uniform) : 0.0;
    start = (1 - mix) * start.array() + mix * uniform;
  }
  w_ = start;
  rows_ = stacked();
  if (!expand()) return false;
  lambda_ = degree_;
  // Multipliers start no larger than the sensitivities they balance.
  const double mu = 0.1 * degree_ * (capped() ? std::min(uniform, (cap_ - w_.array()).minCoeff()) : uniform);
  z_ = (mu / w_.array()).max(1e-3 * degree_);
  y_ = capped() ? Eigen::VectorXd(mu / (cap_ - w_.array())) : Eigen::VectorXd::Zero(s);
  return true;
}

BlockArray::RowMatrix RestrictedDesign::stacked() const {
  const int r = blocks_.rows();
  BlockArray::RowMatrix rows(Eigen::Index(candidates_.size()) * r, blocks_.columns());
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    rows.middleRows(Eigen::Index(i) * r, r) = blocks_.block(std::size_t(candidates_[i]));
  return rows;
}

/// Φ's expansion and d at the present weights; false (and nothing changed) where M is singular.
bool RestrictedDesign::expand() {
  const int m = blocks_.columns(), r = blocks_.rows();
  const auto s = Eigen::Index(candidates_.size());
  BlockArray::RowMatrix scaled(rows_.rows(), m);
  for (Eigen::Index i = 0; i < s; ++i) scaled.middleRows(i * r, r) = std::sqrt(w_[i]) * rows_.middleRows(i * r, r);
  Eigen::MatrixXd information = prior_.size() > 0 ? prior_ : Eigen::MatrixXd::Zero(m, m);
  information.selfadjointView<Eigen::Lower>().rankUpdate(scaled.transpose());
  information.triangularView<Eigen::StrictlyUpper>() = information.transpose();
  auto expansion = function_.expand(information);
  if (expansion == nullptr) return false;
  expansion_ = std::move(expansion);
  if (prior_.size() > 0) prior_sensitivity_ = (expansion_->factor.transpose() * prior_ * expansion_->factor).trace();
  const BlockArray::RowMatrix rotated = rows_ * expansion_->factor.triangularView<Eigen::Upper>();
  d_.resize(s);
  for (Eigen::Index i = 0; i < s; ++i) d_[i] = rotated.middleRows(i * r, r).squaredNorm();
  return true;
}

double RestrictedDesign::complementarity() const {
  double sum = w_.dot(z_);
  if (capped()) sum += (cap_ - w_.array()).matrix().dot(y_);
  return sum;
}

double RestrictedDesign::gap() const {
  if (!capped()) return (d_.maxCoeff() + prior_sensitivity_) / degree_ - 1;
  return (best_mean({d_.data(), d_.data() + d_.size()}, cap_) + prior_sensitivity_) / degree_ - 1;
}

/// False if no step leaves M regular.
bool RestrictedDesign::newton_step(double mu) {
  const Eigen::ArrayXd room = cap_ - w_.array();
  Eigen::ArrayXd diagonal = z_.array() / w_.array();
  Eigen::ArrayXd right = d_.array() - lambda_ + mu / w_.array();
  if (capped()) {
    diagonal += y_.array() / room;
    right -= mu / room;
  }
  const NewtonSystem system(*expansion_, rows_, blocks_.rows(), diagonal, hessian_);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(w_.size());
  const Eigen::VectorXd a = system.solve(right.matrix()), b = system.solve(ones);
  const double d_lambda = (a.sum() - (1 - w_.sum())) / b.sum();
  const Eigen::VectorXd dw = a - d_lambda * b;
  const Eigen::VectorXd dz = (mu / w_.array() - z_.array() - z_.array() / w_.array() * dw.array()).matrix();
  double primal = step_to_boundary(w_, dw, boundary_fraction), dual = step_to_boundary(z_, dz, boundary_fraction);
  Eigen::VectorXd dy;
  if (capped()) {
    dy = (mu / room - y_.array() + y_.array() / room * dw.array()).matrix();
    primal = std::min(primal, step_to_boundary(room.matrix(), -dw, boundary_fraction));
    dual = std::min(dual, step_to_boundary(y_, dy, boundary_fraction));
  }
  // Criteria that need not know all parameters have optima at singular M: go as near as M stays regular.
  const Eigen::VectorXd before = w_;
  w_ = before + primal * dw;
  for (int halving = 0; !expand(); ++halving) {
    if (halving == max_halvings) {
      w_ = before;
      return false;
    }
    primal *= 0.5;
    w_ = before + primal * dw;
  }
  z_ += dual * dz;
  lambda_ += dual * d_lambda;
  if (capped()) y_ += dual * dy;
  return true;
}

int RestrictedDesign::solve(double target, const Monitor& monitor) {
  const double sides = capped() ? 2.0 : 1.0;
  for (int step = 0; step < max_newton_steps; ++step) {
    // Once the sum of all products weight × multiplier is far below the target, rounding decides the rest.
    const double products = complementarity();
    if (gap() <= target || products < 1e-3 * target * degree_ || monitor.should_stop()) return step;
    if (!newton_step(centring * products / (sides * double(w_.size())))) return step;
  }
  return max_newton_steps;
}

}  // namespace posewright
