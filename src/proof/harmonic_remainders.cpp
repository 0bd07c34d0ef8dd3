#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "posewright/proof/harmonic_rows.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// Eigenvalues of the information below this share of the largest tell nothing of a column.
constexpr double nothing = 1e-12;

using RowMatrix = BlockArray::RowMatrix;

/// JᵀJ ⪯ (1 + α) BᵀB + (1 + 1/α) (Σ ρ_c t_c) diag(ρ_c / t_c), J = B + E, ‖E_c‖ ≤ ρ_c: (theory.md eq. (55)).
class RemainderRows : public HarmonicRows {
 public:
  explicit RemainderRows(std::unique_ptr<HarmonicRows> inside) : inside_(std::move(inside)) {
    parts_ = inside_->parts();
    factors_ = inside_->factors();
    degrees_ = inside_->degrees();
    const auto columns = Eigen::Index(inside_->remainders().size());
    parts_.push_back({int(columns), 0, 0, -1, InverseVariance{1.0}, InverseVariance{}});
    weights_.setOnes(columns);
    choose();
  }

  void tune(const std::vector<std::vector<double>>& configurations, std::span<const double> weights) override;
  std::unique_ptr<Work> work() const override { return inside_->work(); }
  bool at(std::span<const double> q, std::span<const double> factors, Work& work, RowMatrix& B,
          std::span<double> squares) const override {
    if (!inside_->at(q, factors, work, B, squares)) return false;
    const Eigen::Index rows = B.rows(), columns = B.cols();
    B.conservativeResize(rows + columns, columns);
    B.bottomRows(columns).setZero();
    B.bottomRows(columns).diagonal() = own_;
    return true;
  }

 private:
  /// Rows and factors from the weights t and α.
  void choose() {
    const auto rho = Eigen::Map<const Eigen::VectorXd>(inside_->remainders().data(), weights_.size());
    own_ = ((1 + 1 / alpha_) * rho.dot(weights_) * rho.cwiseQuotient(weights_)).cwiseSqrt();
    parts_.front().plus.weight = 1 + alpha_;
  }

  std::unique_ptr<HarmonicRows> inside_;
  Eigen::VectorXd weights_, own_;
  double alpha_ = 1.0;
};

/// t_c is what the optimal weights leave uncertain of a column: its row of T is about as long.
void RemainderRows::tune(const std::vector<std::vector<double>>& configurations, std::span<const double> weights) {
  inside_->tune(configurations, weights);
  const Eigen::Index columns = weights_.size();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(columns, columns);
  const auto work = inside_->work();
  RowMatrix B;
  std::vector<double> factors;
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    factors.clear();
    for (const ColumnFactor& factor : factors_)
      factors.push_back(value_of(factor, configurations[i][std::size_t(factor.coordinate)]));
    if (inside_->at(configurations[i], factors, *work, B, {})) M += weights[i] * B.transpose() * B;
  }
  const Eigen::VectorXd size = M.diagonal().cwiseSqrt();
  if (!(size.maxCoeff() > 0)) return;
  const Eigen::VectorXd unit = size.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit.asDiagonal() * M * unit.asDiagonal());
  Eigen::VectorXd square = Eigen::VectorXd::Zero(columns);
  double rank = 0;
  for (Eigen::Index k = 0; k < columns; ++k) {
    const double value = eigen.eigenvalues()[k];
    if (!(value > nothing * eigen.eigenvalues()[columns - 1])) continue;
    square += eigen.eigenvectors().col(k).cwiseAbs2() / value;
    rank += 1;
  }
  weights_ = square.cwiseSqrt().cwiseProduct(unit);
  // A column that nothing tells of counts as little as the rest.
  double least = std::numeric_limits<double>::infinity();
  for (const double w : weights_)
    if (w > 0) least = std::min(least, w);
  weights_ = weights_.cwiseMax(least);
  const auto rho = Eigen::Map<const Eigen::VectorXd>(inside_->remainders().data(), columns);
  alpha_ = std::max(nothing, rho.dot(weights_) / std::sqrt(rank));
  choose();
}

class DifferenceRows : public HarmonicRows {
 public:
  DifferenceRows(std::unique_ptr<HarmonicRows> one, std::unique_ptr<HarmonicRows> other)
      : one_(std::move(one)), other_(std::move(other)) {
    parts_ = one_->parts();
    parts_.front().turn_degree = std::max(parts_.front().turn_degree, other_->parts().front().turn_degree);
    parts_.front().length_degree = std::max(parts_.front().length_degree, other_->parts().front().length_degree);
    factors_ = one_->factors();
    degrees_ = one_->degrees();
    remainders_.assign(std::max(one_->remainders().size(), other_->remainders().size()), 0.0);
    for (const HarmonicRows* rows : {one_.get(), other_.get()})
      for (std::size_t c = 0; c < rows->remainders().size(); ++c)
        remainders_[c] += rows->remainders()[c] / std::sqrt(2.0);
  }

  void tune(const std::vector<std::vector<double>>& configurations, std::span<const double> weights) override {
    one_->tune(configurations, weights);
    other_->tune(configurations, weights);
  }
  std::unique_ptr<Work> work() const override { return std::make_unique<BothWork>(one_->work(), other_->work()); }
  bool at(std::span<const double> q, std::span<const double> factors, Work& work, RowMatrix& B,
          std::span<double> squares) const override {
    auto& both = static_cast<BothWork&>(work);
    if (!one_->at(q, factors, *both.one, B, squares) || !other_->at(q, factors, *both.other, both.rows, squares))
      return false;
    // The noise of both readings counts.
    B = (B - both.rows) / std::sqrt(2.0);
    return true;
  }

 private:
  struct BothWork : Work {
    BothWork(std::unique_ptr<Work> first, std::unique_ptr<Work> second)
        : one(std::move(first)), other(std::move(second)) {}
    std::unique_ptr<Work> one, other;
    RowMatrix rows;
  };
  std::unique_ptr<HarmonicRows> one_, other_;
};

}  // namespace

std::unique_ptr<HarmonicRows> with_remainders(std::unique_ptr<HarmonicRows> inside) {
  return std::make_unique<RemainderRows>(std::move(inside));
}

std::unique_ptr<HarmonicRows> harmonic_difference(std::unique_ptr<HarmonicRows> one,
                                                  std::unique_ptr<HarmonicRows> other) {
  return std::make_unique<DifferenceRows>(std::move(one), std::move(other));
}

}  // namespace posewright
