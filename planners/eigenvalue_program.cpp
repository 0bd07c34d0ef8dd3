#include "eigenvalue_program.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "posewright/planning/step_to_boundary.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// Share of an even choice mixed into the numbers to begin with.
constexpr double evenly = 0.1;
// Numbers begin no nearer to their upper end, in shares of the room.
constexpr double below_room = 0.99;
// s begins at this share of the least eigenvalue.
constexpr double below_least = 0.8;
// Room that a limit begins with at least, as a share of it.
constexpr double limit_room = 0.05;
// How near to an end a step may come, and what of the complementarity it aims at.
constexpr double to_end = 0.95, aim = 0.3;
constexpr double shorter = 0.8;
constexpr int most_shortenings = 40;
// Rows of a tile of products.
constexpr Eigen::Index product_tile = 96;

}  // namespace

void EigenvalueProgram::sum_weighted(const Eigen::VectorXd& weights, Eigen::MatrixXd& sum) {
  weighted_.resize(rows_->rows(), m_);
  for (Eigen::Index i = 0; i < f_; ++i) weighted_.middleRows(i * r_, r_) = weights[i] * rows_->middleRows(i * r_, r_);
  sum.noalias() = rows_->transpose() * weighted_;
}

bool EigenvalueProgram::begin(const RowMatrix& rows, const Eigen::MatrixXd& known, const Eigen::VectorXd& room,
                              const NumberLimits& limits, const Eigen::VectorXd& numbers) {
  rows_ = &rows;
  known_ = &known;
  limits_ = &limits;
  m_ = rows.cols();
  f_ = room.size();
  room_ = room;
  const double total = numbers.sum();
  n_ = (1 - evenly) * numbers + evenly * total / room.sum() * room;
  n_ = n_.cwiseMin(below_room * room);
  const double missing = total - n_.sum();
  n_ += missing / (room - n_).sum() * (room - n_);
  if (!(n_.array() > 0).all() || !((room - n_).array() > 0).all()) return false;
  sum_weighted(n_, shifted_);
  shifted_ += known;
  trial_ = shifted_.bottomRightCorner(m_ - nuisance_, m_ - nuisance_);
  if (nuisance_ > 0) {
    const Eigen::LLT<Eigen::MatrixXd> nuisance(shifted_.topLeftCorner(nuisance_, nuisance_));
    if (nuisance.info() != Eigen::Success) return false;
    trial_ -= shifted_.bottomLeftCorner(m_ - nuisance_, nuisance_) *
              nuisance.solve(shifted_.topRightCorner(nuisance_, m_ - nuisance_));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(trial_, Eigen::EigenvaluesOnly);
  const double first = eigen.eigenvalues()[0], last = eigen.eigenvalues()[eigen.eigenvalues().size() - 1];
  if (!(first > 1e-12 * last)) return false;
  least_ = below_least * first;
  if (!factorise()) return false;
  const double mu = 1 / inverse_.diagonal().tail(m_ - nuisance_).sum();
  dual_ = mu * inverse_;
  low_ = mu * n_.cwiseInverse();
  high_ = mu * (room_ - n_).cwiseInverse();
  left_.resize(limits.most.size());
  for (Eigen::Index k = 0; k < left_.size(); ++k)
    left_[k] = std::max(limits.most[k] - limits.weights.row(k).dot(n_), limit_room * limits.most[k]);
  limit_price_ = mu * left_.cwiseInverse();
  return take_dual();
}

bool EigenvalueProgram::within_limits() const {
  for (Eigen::Index k = 0; k < left_.size(); ++k)
    if (limits_->weights.row(k).dot(n_) > limits_->most[k]) return false;
  return true;
}

/// M − s P at the present numbers and s, and its inverse.
bool EigenvalueProgram::factorise() {
  sum_weighted(n_, shifted_);
  shifted_ += *known_;
  shifted_.diagonal().tail(m_ - nuisance_).array() -= least_;
  shifted_factor_.compute(shifted_);
  if (shifted_factor_.info() != Eigen::Success) return false;
  inverse_root_.setIdentity(m_, m_);
  shifted_factor_.matrixU().solveInPlace(inverse_root_);
  inverse_.noalias() = inverse_root_ * inverse_root_.transpose();
  return true;
}

/// Bound by E of trace 1.
bool EigenvalueProgram::take_dual() {
  dual_factor_.compute(dual_);
  if (dual_factor_.info() != Eigen::Success) return false;
  dual_root_ = dual_factor_.matrixL();
  dual_trace_ = dual_root_.bottomRows(m_ - nuisance_).squaredNorm();
  dual_rows_.noalias() = *rows_ * dual_root_;
  shares_.resize(f_);
  for (Eigen::Index i = 0; i < f_; ++i) shares_[i] = dual_rows_.middleRows(i * r_, r_).squaredNorm() / dual_trace_;
  mixed_.noalias() = *known_ * dual_root_;
  known_share_ = dual_root_.cwiseProduct(mixed_).sum() / dual_trace_;
  prices_ = limit_price_ / dual_trace_;
  return true;
}

/// Lower triangle of H_ij = tr(J_i S⁻¹ J_jᵀ J_j E J_iᵀ) plus what the ends of the numbers and the limits add, bordered
/// by s; S = M − s P.
void EigenvalueProgram::curvature() {
  inverse_rows_.noalias() = *rows_ * inverse_root_;
  hessian_.resize(f_ + 1, f_ + 1);
  const Eigen::Index step = std::max<Eigen::Index>(1, product_tile / r_);
  for (Eigen::Index first = 0; first < f_; first += step) {
    const Eigen::Index columns = std::min(step, f_ - first);
    for (Eigen::Index top = first; top < f_; top += step) {
      const Eigen::Index rows = std::min(step, f_ - top);
      inverse_tile_.noalias() = inverse_rows_.middleRows(top * r_, rows * r_) *
                                inverse_rows_.middleRows(first * r_, columns * r_).transpose();
      dual_tile_.noalias() =
          dual_rows_.middleRows(top * r_, rows * r_) * dual_rows_.middleRows(first * r_, columns * r_).transpose();
      if (r_ == 1) {
        hessian_.block(top, first, rows, columns) = inverse_tile_.cwiseProduct(dual_tile_);
        continue;
      }
      for (Eigen::Index j = 0; j < columns; ++j)
        for (Eigen::Index i = 0; i < rows; ++i)
          hessian_(top + i, first + j) =
              inverse_tile_.block(i * r_, j * r_, r_, r_).cwiseProduct(dual_tile_.block(i * r_, j * r_, r_, r_)).sum();
    }
  }
  // S⁻¹ P E, symmetric.
  const Eigen::Index interest = m_ - nuisance_;
  trial_.noalias() = inverse_.rightCols(interest) * dual_.bottomRows(interest);
  mixed_ = 0.5 * (trial_ + trial_.transpose());
  weighted_.noalias() = *rows_ * mixed_;
  inverse_shares_.resize(f_);
  mixed_shares_.resize(f_);
  for (Eigen::Index i = 0; i < f_; ++i) {
    inverse_shares_[i] = inverse_rows_.middleRows(i * r_, r_).squaredNorm();
    mixed_shares_[i] = weighted_.middleRows(i * r_, r_).cwiseProduct(rows_->middleRows(i * r_, r_)).sum();
    hessian_(i, i) += low_[i] / n_[i] + high_[i] / (room_[i] - n_[i]);
    hessian_(f_, i) = -mixed_shares_[i];
  }
  hessian_(f_, f_) = mixed_.bottomRightCorner(interest, interest).trace();
  for (Eigen::Index k = 0; k < left_.size(); ++k)
    hessian_.topLeftCorner(f_, f_).selfadjointView<Eigen::Lower>().rankUpdate(limits_->weights.row(k).transpose(),
                                                                              limit_price_[k] / left_[k]);
}

double EigenvalueProgram::complementarity() const {
  const double sum =
      shifted_.cwiseProduct(dual_).sum() + n_.dot(low_) + (room_ - n_).dot(high_) + left_.dot(limit_price_);
  return sum / double(m_ + 2 * f_ + left_.size());
}

/// Newton's direction to where all products of the complementarity are `target`.
void EigenvalueProgram::direction(double target) {
  const Eigen::Index K = left_.size();
  solution_.resize(f_ + 1, 2);
  solution_.col(0).head(f_) =
      target * (inverse_shares_.array() + n_.array().inverse() - (room_ - n_).array().inverse());
  solution_(f_, 0) = 1 - target * inverse_.diagonal().tail(m_ - nuisance_).sum();
  solution_.col(1).head(f_).setOnes();
  solution_(f_, 1) = 0.0;
  d_left_.resize(K);
  d_price_.resize(K);
  for (Eigen::Index k = 0; k < K; ++k) {
    d_left_[k] = limits_->most[k] - limits_->weights.row(k).dot(n_) - left_[k];
    solution_.col(0).head(f_) -=
        (target - limit_price_[k] * d_left_[k]) / left_[k] * limits_->weights.row(k).transpose();
  }
  factor_.solveInPlace(solution_);
  solution_.col(0) -= solution_.col(0).head(f_).sum() / solution_.col(1).head(f_).sum() * solution_.col(1);
  d_n_ = solution_.col(0).head(f_);
  d_least_ = solution_(f_, 0);
  for (Eigen::Index k = 0; k < K; ++k) {
    d_left_[k] -= limits_->weights.row(k).dot(d_n_);
    d_price_[k] = (target - limit_price_[k] * d_left_[k]) / left_[k] - limit_price_[k];
  }
  d_low_ = (target - low_.array() * d_n_.array()) / n_.array() - low_.array();
  d_high_ = (target + high_.array() * d_n_.array()) / (room_ - n_).array() - high_.array();
  sum_weighted(d_n_, d_shifted_);
  d_shifted_.diagonal().tail(m_ - nuisance_).array() -= d_least_;
  mixed_.noalias() = d_shifted_ * dual_;
  trial_.noalias() = inverse_ * mixed_;
  d_dual_ = target * inverse_ - dual_ - 0.5 * (trial_ + trial_.transpose());
}

/// As far along the direction as everything stays inside, numbers and multipliers each by themselves.
void EigenvalueProgram::advance() {
  double primal = std::min(step_to_boundary(n_, d_n_, to_end), step_to_boundary(left_, d_left_, to_end));
  d_n_ = -d_n_;
  primal = std::min(primal, step_to_boundary(room_ - n_, d_n_, to_end));
  d_n_ = -d_n_;
  double dual = std::min({step_to_boundary(low_, d_low_, to_end), step_to_boundary(high_, d_high_, to_end),
                          step_to_boundary(limit_price_, d_price_, to_end)});
  for (int k = 0; k < most_shortenings; ++k, primal *= shorter) {
    trial_ = shifted_ + primal / to_end * d_shifted_;
    shifted_factor_.compute(trial_);
    if (shifted_factor_.info() == Eigen::Success) break;
  }
  for (int k = 0; k < most_shortenings; ++k, dual *= shorter) {
    trial_ = dual_ + std::min(1.0, dual / to_end) * d_dual_;
    dual_factor_.compute(trial_);
    if (dual_factor_.info() == Eigen::Success) break;
  }
  n_ += primal * d_n_;
  least_ += primal * d_least_;
  left_ += primal * d_left_;
  low_ += dual * d_low_;
  high_ += dual * d_high_;
  limit_price_ += dual * d_price_;
  dual_ += dual * d_dual_;
}

bool EigenvalueProgram::step() {
  curvature();
  factor_.compute(hessian_);
  if (factor_.info() != Eigen::Success) return false;
  direction(aim * complementarity());
  if (!d_n_.allFinite() || !std::isfinite(d_least_)) return false;
  advance();
  return factorise() && take_dual();
}

}  // namespace posewright
