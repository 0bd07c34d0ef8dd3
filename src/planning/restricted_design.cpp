#include "restricted_design.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr int max_newton_steps = 80;
// Ratio of Cholesky pivots below which the information of whitened blocks counts as singular.
constexpr double singular_pivot = 1e-7;
// Fraction of the way to the boundary that a step may go.
constexpr double boundary_fraction = 0.995;
// Each step aims at this share of the present products weight × multiplier.
constexpr double centring = 0.1;

/// Largest step ≤ 1 that keeps x + step·dx > 0.
double step_to_boundary(const Eigen::VectorXd& x, const Eigen::VectorXd& dx) {
  double step = 1.0;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (dx[i] < 0) step = std::min(step, -boundary_fraction * x[i] / dx[i]);
  return step;
}

}  // namespace

RestrictedDesign::RestrictedDesign(const BlockArray& blocks, int nuisance, double cap, const Eigen::MatrixXd& prior)
    : blocks_(blocks), nuisance_(nuisance), interest_(blocks.columns() - nuisance), cap_(cap), prior_(prior) {}

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
  if (!factorise()) return false;
  lambda_ = interest_;
  // Multipliers start no larger than the sensitivities they balance.
  const double mu = 0.1 * interest_ * (capped() ? std::min(uniform, (cap_ - w_.array()).minCoeff()) : uniform);
  z_ = (mu / w_.array()).max(1e-3 * interest_);
  y_ = capped() ? Eigen::VectorXd(mu / (cap_ - w_.array())) : Eigen::VectorXd::Zero(s);
  return true;
}

bool RestrictedDesign::factorise() {
  const int m = blocks_.columns(), r = blocks_.rows();
  const auto s = Eigen::Index(candidates_.size());
  BlockArray::RowMatrix rows(s * r, m);
  for (Eigen::Index i = 0; i < s; ++i)
    rows.middleRows(i * r, r) = blocks_.block(std::size_t(candidates_[std::size_t(i)]));
  BlockArray::RowMatrix scaled(s * r, m);
  for (Eigen::Index i = 0; i < s; ++i) scaled.middleRows(i * r, r) = std::sqrt(w_[i]) * rows.middleRows(i * r, r);
  Eigen::MatrixXd information = prior_.size() > 0 ? prior_ : Eigen::MatrixXd::Zero(m, m);
  information.selfadjointView<Eigen::Lower>().rankUpdate(scaled.transpose());
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  if (factor.info() != Eigen::Success ||
      !(factor.matrixLLT().diagonal().minCoeff() > singular_pivot * factor.matrixLLT().diagonal().maxCoeff()))
    return false;
  log_det_ = 2 * factor.matrixLLT().diagonal().tail(interest_).array().log().sum();
  inverse_factor_ = factor.matrixL().solve(Eigen::MatrixXd::Identity(m, m));
  if (prior_.size() > 0)
    prior_sensitivity_ = (inverse_factor_ * prior_ * inverse_factor_.transpose()).diagonal().tail(interest_).sum();
  rotated_.noalias() = rows * inverse_factor_.transpose();
  // Leading entries of L⁻¹x are the nuisance block's own: d_i is what the interest entries add.
  d_.resize(s);
  for (Eigen::Index i = 0; i < s; ++i) d_[i] = rotated_.middleRows(i * r, r).rightCols(interest_).squaredNorm();
  return true;
}

void RestrictedDesign::fill_hessian() {
  const int m = blocks_.columns(), r = blocks_.rows();
  const auto s = Eigen::Index(candidates_.size());
  if (r == 1) {
    const Eigen::MatrixXd all = rotated_ * rotated_.transpose();
    hessian_ = all.cwiseAbs2();
    if (nuisance_ > 0) {
      const Eigen::MatrixXd part = rotated_.leftCols(nuisance_) * rotated_.leftCols(nuisance_).transpose();
      hessian_ -= part.cwiseAbs2();
    }
    return;
  }
  // ‖Z_i Z_jᵀ‖² = ⟨Z_iᵀZ_i, Z_jᵀZ_j⟩: rows of symmetric products, without the entries that are nuisance on both sides.
  const Eigen::Index pairs = Eigen::Index(m) * (m + 1) / 2 - Eigen::Index(nuisance_) * (nuisance_ + 1) / 2;
  BlockArray::RowMatrix products(s, pairs);
  Eigen::MatrixXd square(m, m);
  for (Eigen::Index i = 0; i < s; ++i) {
    const auto zi = rotated_.middleRows(i * r, r);
    square.noalias() = zi.transpose() * zi;
    Eigen::Index k = 0;
    for (int b = nuisance_; b < m; ++b) {
      for (int a = 0; a < b; ++a) products(i, k++) = std::sqrt(2.0) * square(a, b);
      products(i, k++) = square(b, b);
    }
  }
  hessian_.resize(s, s);
  hessian_.setZero();
  hessian_.selfadjointView<Eigen::Lower>().rankUpdate(products);
  hessian_.triangularView<Eigen::StrictlyUpper>() = hessian_.transpose();
}

double RestrictedDesign::complementarity() const {
  double sum = w_.dot(z_);
  if (capped()) sum += (cap_ - w_.array()).matrix().dot(y_);
  return sum;
}

double RestrictedDesign::gap() const {
  if (!capped()) return (d_.maxCoeff() + prior_sensitivity_) / interest_ - 1;
  // Best feasible mean sensitivity on the working set: fill the largest up to the cap.
  std::vector<double> sorted(d_.data(), d_.data() + d_.size());
  const auto top = std::min<std::size_t>(sorted.size(), std::size_t(std::lround(1 / cap_)));
  std::partial_sort(sorted.begin(), sorted.begin() + std::ptrdiff_t(top), sorted.end(), std::greater<>());
  double sum = 0;
  for (std::size_t i = 0; i < top; ++i) sum += sorted[i];
  return (sum / double(top) + prior_sensitivity_) / interest_ - 1;
}

void RestrictedDesign::newton_step(double mu) {
  fill_hessian();
  const Eigen::ArrayXd room = cap_ - w_.array();
  Eigen::ArrayXd diagonal = z_.array() / w_.array();
  Eigen::ArrayXd right = d_.array() - lambda_ + mu / w_.array();
  if (capped()) {
    diagonal += y_.array() / room;
    right -= mu / room;
  }
  hessian_.diagonal() += diagonal.matrix();
  const Eigen::LLT<Eigen::MatrixXd> factor(hessian_);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(w_.size());
  const Eigen::VectorXd a = factor.solve(right.matrix()), b = factor.solve(ones);
  const double d_lambda = (a.sum() - (1 - w_.sum())) / b.sum();
  const Eigen::VectorXd dw = a - d_lambda * b;
  const Eigen::VectorXd dz = (mu / w_.array() - z_.array() - z_.array() / w_.array() * dw.array()).matrix();
  double primal = step_to_boundary(w_, dw), dual = step_to_boundary(z_, dz);
  Eigen::VectorXd dy;
  if (capped()) {
    dy = (mu / room - y_.array() + y_.array() / room * dw.array()).matrix();
    primal = std::min(primal, step_to_boundary(room.matrix(), -dw));
    dual = std::min(dual, step_to_boundary(y_, dy));
  }
  w_ += primal * dw;
  z_ += dual * dz;
  lambda_ += dual * d_lambda;
  if (capped()) y_ += dual * dy;
}

int RestrictedDesign::solve(double target) {
  const double sides = capped() ? 2.0 : 1.0;
  for (int step = 0; step < max_newton_steps; ++step) {
    // Once the sum of all products weight × multiplier is far below the target, rounding decides the rest.
    const double products = complementarity();
    if (gap() <= target || products < 1e-3 * target * interest_) return step;
    newton_step(centring * products / (sides * double(w_.size())));
    if (!factorise())
      throw CannotDo("the optimal weights leave the information singular: some parameter is not needed");
  }
  return max_newton_steps;
}

}  // namespace posewright
