#include "posewright/planning/eigenvalue_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// Share of an even choice mixed into the numbers to begin with.
constexpr double inward = 0.1;
// How near to an end of its range a step may bring a number.
constexpr double to_boundary = 0.95;
// μ falls by this once the square of the Newton decrement is below 1: then the step leaves next to nothing.
constexpr double fall = 0.15, centred = 1.0;

// Rows of a tile of products: those of all pairs of candidates would fill hundreds of megabytes at every step.
constexpr Eigen::Index tile_rows = 96;
// Numbers of the symmetric products of all candidates: 80 MB.
constexpr Eigen::Index most_products = 10'000'000;

/// Lower triangle of H_ij += ‖Z_i Z_jᵀ‖² of blocks of r rows, pair by pair.
void add_squares_by_pairs(const EigenvalueRelaxation::RowMatrix& Z, Eigen::Index r, Eigen::Ref<Eigen::MatrixXd> H,
                          Eigen::MatrixXd& tile) {
  const Eigen::Index n = H.cols(), step = std::max<Eigen::Index>(1, tile_rows / r);
  for (Eigen::Index first = 0; first < n; first += step) {
    const Eigen::Index columns = std::min(step, n - first);
    for (Eigen::Index top = first; top < n; top += step) {
      const Eigen::Index rows = std::min(step, n - top);
      tile.resize(rows * r, columns * r);
      tile.noalias() = Z.middleRows(top * r, rows * r) * Z.middleRows(first * r, columns * r).transpose();
      for (Eigen::Index j = 0; j < columns; ++j)
        for (Eigen::Index i = 0; i < rows; ++i)
          H(top + i, first + j) += r == 1 ? tile(i, j) * tile(i, j) : tile.block(i * r, j * r, r, r).squaredNorm();
    }
  }
}

/// This sum by symmetric products, ‖Z_i Z_jᵀ‖² = ⟨Z_iᵀZ_i, Z_jᵀZ_j⟩.
void add_squares_by_blocks(const EigenvalueRelaxation::RowMatrix& Z, Eigen::Index r, Eigen::Ref<Eigen::MatrixXd> H) {
  const Eigen::Index n = H.cols(), m = Z.cols();
  Eigen::MatrixXd products(m * (m + 1) / 2, n), square(m, m);
  for (Eigen::Index i = 0; i < n; ++i) {
    square.noalias() = Z.middleRows(i * r, r).transpose() * Z.middleRows(i * r, r);
    Eigen::Index at = 0;
    for (Eigen::Index b = 0; b < m; at += m - b, ++b) {
      products.col(i).segment(at, m - b) = std::sqrt(2.0) * square.col(b).tail(m - b);
      products(at, i) = square(b, b);
    }
  }
  H.selfadjointView<Eigen::Lower>().rankUpdate(products.transpose());
}

/// The way that takes less of both.
void add_squares(const EigenvalueRelaxation::RowMatrix& Z, Eigen::Index r, Eigen::Ref<Eigen::MatrixXd> H,
                 Eigen::MatrixXd& tile) {
  const Eigen::Index m = Z.cols();
  if (m + 1 < 2 * r * r && m * (m + 1) / 2 * H.cols() <= most_products) add_squares_by_blocks(Z, r, H);
  else add_squares_by_pairs(Z, r, H, tile);
}

Eigen::MatrixXd inverse_factor(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  return factor.matrixU().solve(Eigen::MatrixXd::Identity(factor.rows(), factor.rows()));
}

}  // namespace

EigenvalueRelaxation::EigenvalueRelaxation(RowMatrix rows, int r, int nuisance, Eigen::MatrixXd known,
                                           Eigen::VectorXd room, const Eigen::VectorXd& numbers, bool with_ratio)
    : rows_(std::move(rows)),
      r_(r),
      nuisance_(nuisance),
      m_(rows_.cols()),
      f_(room.size()),
      known_(std::move(known)),
      room_(std::move(room)),
      with_ratio_(with_ratio) {
  const double total = numbers.sum();
  const double all = room_.sum();
  n_ = (1 - inward) * numbers + inward * total / all * room_;
  // Numbers at their upper end leave it.
  n_ = n_.cwiseMin(0.999 * room_);
  const double missing = total - n_.sum();
  n_ += missing / (room_ - n_).sum() * (room_ - n_);
  if (!(n_.array() > 0).all() || !((room_ - n_).array() > 0).all()) return;
  information_ = known_;
  for (Eigen::Index i = 0; i < f_; ++i)
    information_.noalias() += n_[i] * rows_.middleRows(i * r_, r_).transpose() * rows_.middleRows(i * r_, r_);
  Eigen::MatrixXd interest = information_.bottomRightCorner(m_ - nuisance_, m_ - nuisance_);
  if (nuisance_ > 0) {
    const Eigen::LLT<Eigen::MatrixXd> factor(information_.topLeftCorner(nuisance_, nuisance_));
    if (factor.info() != Eigen::Success) return;
    interest -= information_.bottomLeftCorner(m_ - nuisance_, nuisance_) *
                factor.solve(information_.topRightCorner(nuisance_, m_ - nuisance_));
  }
  const Eigen::VectorXd lambda =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(interest, Eigen::EigenvaluesOnly).eigenvalues();
  const double last = lambda[lambda.size() - 1];
  if (!(lambda[0] > 1e-12 * last)) return;
  least_ = 0.9 * lambda[0];
  most_ = 1.1 * last;
  regular_ = factorise(n_, least_, most_);
  if (!regular_) return;
  mu_ = 1 / inverse_factor(low_).bottomRows(m_ - nuisance_).squaredNorm();
}

bool EigenvalueRelaxation::factorise(const Eigen::VectorXd& n, double least, double most) {
  scaled_ = rows_;
  for (Eigen::Index i = 0; i < f_; ++i) scaled_.middleRows(i * r_, r_) *= std::sqrt(n[i]);
  information_ = known_;
  information_.selfadjointView<Eigen::Lower>().rankUpdate(scaled_.transpose());
  information_.triangularView<Eigen::StrictlyUpper>() = information_.transpose();
  shifted_ = information_;
  shifted_.diagonal().tail(m_ - nuisance_).array() -= least;
  low_.compute(shifted_);
  if (low_.info() != Eigen::Success) return false;
  if (!with_ratio_) return true;
  shifted_ = -information_;
  shifted_.diagonal().array() += most;
  high_.compute(shifted_);
  return high_.info() == Eigen::Success;
}

double EigenvalueRelaxation::gap() const { return mu_ * double((with_ratio_ ? 2 : 1) * m_ + 2 * f_); }

Eigen::MatrixXd EigenvalueRelaxation::least_factor() const {
  const Eigen::MatrixXd inverse = inverse_factor(low_);
  return inverse / inverse.bottomRows(m_ - nuisance_).norm();
}

Eigen::MatrixXd EigenvalueRelaxation::most_factor() const {
  const Eigen::MatrixXd inverse = inverse_factor(high_);
  return inverse / inverse.norm();
}

/// Gradient and curvature of (s − tL)/μ + log det(M − s P) + log det(L I − M) + Σ ln n_i + Σ ln(room_i − n_i), but for
/// the terms of s and L alone; of the curvature the lower triangle.
void EigenvalueRelaxation::products() {
  const Eigen::Index size = f_ + (with_ratio_ ? 2 : 1);
  hessian_.setZero(size, size);
  gradient_.setZero(size);
  const Eigen::ArrayXd above = n_.array().inverse(), below = (room_ - n_).array().inverse();
  gradient_.head(f_) = above - below;
  hessian_.diagonal().head(f_) = above.square() + below.square();
  const auto add = [&](const Eigen::MatrixXd& inverse, Eigen::Index first, double sign, Eigen::Index at) {
    RowMatrix &Z = scaled_, &mixed = mixed_;
    Z.noalias() = rows_ * inverse;
    add_squares(Z, r_, hessian_.topLeftCorner(f_, f_), tile_);
    // V P V in the same factor: B Bᵀ with B = L⁻¹ P L⁻ᵀ.
    const Eigen::MatrixXd own = inverse.bottomRows(m_ - first).transpose() * inverse.bottomRows(m_ - first);
    mixed.noalias() = Z * own;
    for (Eigen::Index i = 0; i < f_; ++i) {
      const auto Zi = Z.middleRows(i * r_, r_);
      gradient_[i] += sign * Zi.squaredNorm();
      hessian_(at, i) = -mixed.middleRows(i * r_, r_).cwiseProduct(Zi).sum();
    }
    gradient_[at] -= sign * own.trace();
    hessian_(at, at) += own.squaredNorm();
  };
  add(inverse_factor(low_), nuisance_, 1.0, f_);
  if (with_ratio_) add(inverse_factor(high_), 0, -1.0, f_ + 1);
}

bool EigenvalueRelaxation::step(double t) {
  products();
  gradient_[f_] += 1 / mu_;
  if (with_ratio_) gradient_[f_ + 1] -= t / mu_;
  factor_.compute(hessian_);
  if (factor_.info() != Eigen::Success) return false;
  Eigen::VectorXd ones = Eigen::VectorXd::Zero(hessian_.rows());
  ones.head(f_).setOnes();
  change_ = factor_.solve(gradient_);
  const Eigen::VectorXd b = factor_.solve(ones);
  change_ -= change_.head(f_).sum() / b.head(f_).sum() * b;
  const double decrement = change_.dot(gradient_);
  if (!(decrement >= 0) || !std::isfinite(decrement)) return false;
  double length = 1.0;
  for (Eigen::Index i = 0; i < f_; ++i) {
    if (change_[i] < 0) length = std::min(length, to_boundary * n_[i] / -change_[i]);
    else if (change_[i] > 0) length = std::min(length, to_boundary * (room_[i] - n_[i]) / change_[i]);
  }
  const auto move = [&](double by) {
    return factorise(n_ + by * change_.head(f_), least_ + by * change_[f_],
                     with_ratio_ ? most_ + by * change_[f_ + 1] : most_);
  };
  const double whole = length;
  while (!move(length)) {
    length *= 0.7;
    if (length < 1e-4) {
      move(0.0);
      return false;
    }
  }
  // Not to the very edge of what is positive definite: that is a convex set, so that less is inside too.
  if (length < whole) move(length *= 0.8);
  n_ += length * change_.head(f_);
  least_ += length * change_[f_];
  if (with_ratio_) most_ += length * change_[f_ + 1];
  if (decrement < centred) mu_ *= fall;
  return true;
}

}  // namespace posewright
