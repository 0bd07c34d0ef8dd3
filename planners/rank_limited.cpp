#include "rank_limited.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace posewright {
namespace {

class RankLimitedExpansion : public Expansion {
 public:
  Eigen::MatrixXd basis;     // rows of blocks times this: in eigenvectors of W, falling order
  Eigen::MatrixXd weight;    // √ of what a product of entries (a, b) of J_iᵀJ_i counts, a ≤ b
  double tail_weight = 0.0;  // of the trace over the tail
  int head = 0;              // k

  void curvature(const BlockArray::RowMatrix& rows, int r, Eigen::MatrixXd& H) const override {
    const Eigen::Index m = basis.cols(), s = rows.rows() / r;
    const BlockArray::RowMatrix Y = rows * basis;
    BlockArray::RowMatrix features(s, m * (m + 1) / 2 + 1);
    Eigen::MatrixXd A(m, m);
    for (Eigen::Index i = 0; i < s; ++i) {
      A.noalias() = Y.middleRows(i * r, r).transpose() * Y.middleRows(i * r, r);
      Eigen::Index k = 0;
      for (Eigen::Index b = 0; b < m; ++b)
        for (Eigen::Index a = 0; a <= b; ++a) features(i, k++) = weight(a, b) * A(a, b);
      features(i, k) = tail_weight * A.diagonal().tail(m - head).sum();
    }
    H.noalias() = features * features.transpose();
  }
};

}  // namespace

RankLimitedLogDet::RankLimitedLogDet(const Eigen::MatrixXd& known, double ridge, int rank) : rank_(rank) {
  const Eigen::Index m = known.rows();
  Eigen::MatrixXd regular = known;
  regular.diagonal().array() += ridge;
  const Eigen::LLT<Eigen::MatrixXd> factor(regular);
  log_det_ = 2 * factor.matrixLLT().diagonal().array().log().sum();
  to_white_ = factor.matrixU().solve(Eigen::MatrixXd::Identity(m, m));
}

std::unique_ptr<Expansion> RankLimitedLogDet::expand(const Eigen::MatrixXd& added) const {
  const Eigen::Index m = added.rows();
  const Eigen::MatrixXd W = to_white_.transpose() * added * to_white_;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(W);
  if (eigen.info() != Eigen::Success) return nullptr;
  const Eigen::VectorXd lambda = eigen.eigenvalues().reverse().cwiseMax(0.0);
  auto result = std::make_unique<RankLimitedExpansion>();
  double rest = lambda.sum();
  int k = 0;
  while (k < rank_ - 1 && lambda[k] > rest / (rank_ - k)) rest -= lambda[k++];
  rest = std::max(0.0, lambda.tail(m - k).sum());
  const double t = rest / (rank_ - k);
  Eigen::VectorXd slope(m);
  slope.head(k) = (1 + lambda.head(k).array()).inverse();
  slope.tail(m - k).setConstant(1 / (1 + t));
  // Each eigenvalue may be off by some roundings of the largest.
  const double rounding = 10 * std::numeric_limits<double>::epsilon() * double(m) * lambda[0];
  result->value =
      log_det_ + (1 + lambda.head(k).array()).log().sum() + (rank_ - k) * std::log1p(t) + rounding * slope.sum();
  result->head = k;
  result->basis = to_white_ * eigen.eigenvectors().rowwise().reverse();
  result->factor = result->basis * slope.cwiseSqrt().asDiagonal();
  result->weight = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index a = 0; a < k; ++a) {
    result->weight(a, a) = slope[a];
    for (Eigen::Index b = a + 1; b < m; ++b) {
      const double pair =
          b < k ? slope[a] * slope[b] : (slope[b] - slope[a]) / std::max(lambda[a] - lambda[b], 1e-12 * lambda[a]);
      result->weight(a, b) = std::sqrt(2 * std::max(0.0, pair));
    }
  }
  result->tail_weight = slope[m - 1] / std::sqrt(double(rank_ - k));
  return result;
}

}  // namespace posewright
