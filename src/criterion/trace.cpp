#include "posewright/criterion/trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "product_curvature.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

/// A_t in whitened coordinates: tr(A M_raw⁻¹ Aᵀ) = tr(A_w M⁻¹ A_wᵀ), A_w = A R⁻¹.
Eigen::MatrixXd whitened(const CriterionData& data, const Eigen::MatrixXd& A) {
  Eigen::MatrixXd result = A;
  data.R.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(result);
  return result;
}

void require_test_points(const CriterionData& data) {
  if (data.test_points.empty())
    throw CannotDo("the criterion needs places where accuracy matters: set design: test_poses");
  if (!any_is_moved(data.test_points))
    throw CannotDo(
        "no parameter that is identified moves the robot at the test poses, so that every plan is as accurate there: "
        "other test_poses (an elastic arm: another load_case) or another criterion");
}

class TraceExpansion : public Expansion {
 public:
  TraceExpansion(const Eigen::LLT<Eigen::MatrixXd>& llt, const Eigen::MatrixXd& A) {
    const Eigen::Index m = llt.rows();
    inverse_ = llt.matrixL().solve(Eigen::MatrixXd::Identity(m, m)).transpose();
    const Eigen::MatrixXd VA = inverse_ * (inverse_.transpose() * A.transpose());
    const double variance = A.transpose().cwiseProduct(VA).sum();
    value = -std::log(variance);
    factor = upper_factor(VA / std::sqrt(variance));
  }

  /// (2/φ) tr(X_i V X_j B) − d_i d_j with X = JᵀJ, B = V AᵀA V: the product is ⟨P_i, P_j⟩, P = (J L⁻ᵀ)ᵀ(J T √φ).
  void curvature(const BlockArray::RowMatrix& rows, int r, Eigen::MatrixXd& H) const override {
    const BlockArray::RowMatrix G = rows * factor;
    const Eigen::VectorXd d = product_curvature(rows * inverse_, G, r, H);
    H.noalias() -= d * d.transpose();
  }

 private:
  Eigen::MatrixXd inverse_;  // L⁻ᵀ
};

// The largest variance is curved by the mean (Σ v_tᵖ)^{1/p} in place of it.
constexpr double worst_smoothing = 60.0;

/// −ln of a weighted mean of the variances v_t, weights μ_t ∝ v_t^{p−1} that sum to one: no design makes the largest of
/// them smaller than the mean, so that what bounds the mean bounds the largest.
class WorstExpansion : public Expansion {
 public:
  WorstExpansion(const Eigen::LLT<Eigen::MatrixXd>& llt, const std::vector<Eigen::MatrixXd>& points) {
    const auto count = Eigen::Index(points.size());
    Eigen::ArrayXd variance(count);
    for (Eigen::Index t = 0; t < count; ++t) {
      halves_.push_back(llt.solve(points[std::size_t(t)].transpose()));
      variance[t] = points[std::size_t(t)].transpose().cwiseProduct(halves_.back()).sum();
    }
    const double largest = variance.maxCoeff();
    share_ = (variance / largest).pow(worst_smoothing);
    share_ /= share_.sum();
    Eigen::Index rows = 0;
    for (const Eigen::MatrixXd& A : points) rows += A.rows();
    Eigen::MatrixXd together(rows, llt.rows());
    rows = 0;
    for (Eigen::Index t = 0; t < count; ++t) {
      const Eigen::MatrixXd& A = points[std::size_t(t)];
      // Points that nothing moves have no variance and no share.
      together.middleRows(rows, A.rows()) = variance[t] > 0 ? std::sqrt(share_[t] / variance[t]) * A : 0.0 * A;
      rows += A.rows();
      halves_[std::size_t(t)] *= variance[t] > 0 ? 1 / std::sqrt(variance[t]) : 0.0;
    }
    mean_ = std::make_unique<TraceExpansion>(llt, together);
    factor = mean_->factor;
    value = std::log((variance > 0).select(share_ / variance, 0.0).sum());
  }

  /// Derivatives of (Σ v_tᵖ)^{1/p}: of the mean, and of its weights.
  void curvature(const BlockArray::RowMatrix& rows, int r, Eigen::MatrixXd& H) const override {
    mean_->curvature(rows, r, H);
    const Eigen::Index count = rows.rows() / r;
    Eigen::MatrixXd d(count, Eigen::Index(halves_.size()));
    for (Eigen::Index t = 0; t < d.cols(); ++t) {
      const Eigen::MatrixXd Y = rows * halves_[std::size_t(t)];
      for (Eigen::Index i = 0; i < count; ++i) d(i, t) = Y.middleRows(i * r, r).squaredNorm();
    }
    const Eigen::VectorXd mean = d * share_.matrix();
    const Eigen::MatrixXd spread = (d.colwise() - mean) * ((worst_smoothing - 1) * share_).sqrt().matrix().asDiagonal();
    H.noalias() += spread * spread.transpose();
  }

 private:
  Eigen::ArrayXd share_;
  std::vector<Eigen::MatrixXd> halves_;  // V Aᵀ/√v of every point
  std::unique_ptr<TraceExpansion> mean_;
};

class WorstTestPoint : public InformationFunction {
 public:
  explicit WorstTestPoint(const CriterionData& data) {
    for (const TestPoint& t : data.test_points) points_.push_back(whitened(data, t.A));
  }

  double value(const Eigen::MatrixXd& information) const override {
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    return is_regular(factor) ? -std::log(worst(factor).second) : -infinity;
  }

  /// Supergradient: gradient of the worst point.
  Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const override {
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    const auto [point, variance] = worst(factor);
    const Eigen::MatrixXd half = factor.solve(points_[point].transpose());
    return half * half.transpose() / variance;
  }

  bool concave() const override { return true; }

  double degree() const override { return 1.0; }

  std::unique_ptr<Expansion> expand(const Eigen::MatrixXd& information) const override {
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    if (!is_regular(factor)) return nullptr;
    return std::make_unique<WorstExpansion>(factor, points_);
  }

 private:
  std::pair<std::size_t, double> worst(const Eigen::LLT<Eigen::MatrixXd>& factor) const {
    std::pair<std::size_t, double> result{0, -1.0};
    for (std::size_t t = 0; t < points_.size(); ++t) {
      const double variance = factor.matrixL().solve(points_[t].transpose()).squaredNorm();
      if (variance > result.second) result = {t, variance};
    }
    return result;
  }

  std::vector<Eigen::MatrixXd> points_;
};

}  // namespace

bool any_is_moved(const std::vector<TestPoint>& points) {
  return std::ranges::any_of(points, [](const TestPoint& t) { return !t.A.isZero(0); });
}

Eigen::MatrixXd variance_rows(const CriterionData& data) {
  const Eigen::Index m = data.R.cols();
  Eigen::MatrixXd pick = Eigen::MatrixXd::Zero(m - data.nuisance, m);
  for (Eigen::Index j = data.nuisance; j < m; ++j) pick(j - data.nuisance, j) = 1 / data.scale[j];
  return whitened(data, pick);
}

Eigen::MatrixXd test_point_rows(const CriterionData& data) {
  require_test_points(data);
  double total = 0.0;
  Eigen::Index rows = 0;
  for (const TestPoint& t : data.test_points) {
    total += t.weight;
    rows += t.A.rows();
  }
  Eigen::MatrixXd A(rows, data.R.cols());
  rows = 0;
  for (const TestPoint& t : data.test_points) {
    A.middleRows(rows, t.A.rows()) = std::sqrt(t.weight / total) * t.A;
    rows += t.A.rows();
  }
  // Many points, one matrix of at most m rows: AᵀA is all that counts.
  if (rows > A.cols())
    A = Eigen::HouseholderQR<Eigen::MatrixXd>(A)
            .matrixQR()
            .topRows(A.cols())
            .triangularView<Eigen::Upper>()
            .toDenseMatrix();
  return whitened(data, A);
}

double TraceFunction::value(const Eigen::MatrixXd& information) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  return is_regular(factor) ? -std::log(factor.matrixL().solve(A_.transpose()).squaredNorm()) : -infinity;
}

Eigen::MatrixXd TraceFunction::gradient(const Eigen::MatrixXd& information) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  const Eigen::MatrixXd VA = factor.solve(A_.transpose());
  return VA * VA.transpose() / A_.transpose().cwiseProduct(VA).sum();
}

std::unique_ptr<Expansion> TraceFunction::expand(const Eigen::MatrixXd& information) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  if (!is_regular(factor)) return nullptr;
  return std::make_unique<TraceExpansion>(factor, A_);
}

std::unique_ptr<Criterion> make_worst_test_point_criterion(const CriterionData& data) {
  require_test_points(data);
  return std::make_unique<FunctionCriterion>("test_pose_max", std::make_shared<WorstTestPoint>(data));
}

}  // namespace posewright
