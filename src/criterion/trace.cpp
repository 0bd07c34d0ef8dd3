#include "posewright/criterion/trace.hpp"

#include <cmath>
#include <limits>

#include "posewright/support/error.hpp"
#include "summed_information.hpp"

namespace posewright {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double start_ridge = 1e-3;
// Ratio of squared Cholesky pivots below which whitened information counts as singular.
constexpr double singular_pivot = 1e-11;

/// Running V = M⁻¹ and B = V L V, and of every candidate D_j = J_j V J_jᵀ and T_j = J_j B J_jᵀ (r × r each).
class TraceState : public DesignState {
 public:
  TraceState(const CandidateView& view, std::vector<int> members, const Eigen::MatrixXd& L)
      : DesignState(view, std::move(members)), L_(L), prior_(view.prior), rows_(view.blocks->rows()) {
    refresh();
  }

  double value() const override { return singular_ ? -infinity : -std::log(variance_); }
  double loss(int position) const override { return trace(members()[std::size_t(position)]); }

  Swap best_swap(int position, double min_gain) override {
    const int k = members()[std::size_t(position)];
    const Eigen::MatrixXd Yk = V_ * blocks().block(std::size_t(k)).transpose();
    const Eigen::MatrixXd Zk = B_ * blocks().block(std::size_t(k)).transpose();
    const double leaving = trace(k);
    Swap best{-1, min_gain};
    for (int j = 0; j < int(blocks().count()); ++j) {
      if (trace(j) - leaving <= best.gain * variance_ || blocked()[std::size_t(j)] != 0) continue;
      const double gain = exact_gain(j, k, Yk, Zk);
      if (gain > best.gain) best = {j, gain};
    }
    return best.enter < 0 ? Swap{} : best;
  }

  bool refresh() override {
    const auto m = blocks().columns();
    information_ = summed_information(blocks(), prior_, members());
    singular_ = !invert();
    if (singular_) {
      information_ += start_ridge * Eigen::MatrixXd::Identity(m, m);
      invert();
    }
    return !singular_;
  }

 private:
  void do_apply(int leave, int enter) override {
    information_ += square(enter) - square(leave);
    // A start that was singular may have become regular.
    if (singular_ || !invert()) refresh();
  }

  Eigen::MatrixXd square(int i) const { return block_information(blocks(), i); }

  double trace(int j) const { return traces_[std::size_t(j)]; }

  /// V, B and the pass over all candidates from the information as it is; false where it is singular.
  bool invert() {
    const Eigen::LLT<Eigen::MatrixXd> factor(information_);
    if (factor.info() != Eigen::Success) return false;
    const Eigen::VectorXd pivots = factor.matrixLLT().diagonal();
    if (!(pivots.minCoeff() > std::sqrt(singular_pivot) * pivots.maxCoeff())) return false;
    V_ = factor.solve(Eigen::MatrixXd::Identity(information_.rows(), information_.cols()));
    B_ = V_ * L_ * V_;
    variance_ = V_.cwiseProduct(L_).sum();
    pass();
    return true;
  }

  void pass() {
    const std::size_t n = blocks().count();
    const Eigen::Index r = rows_;
    own_.resize(std::size_t(2 * r * r) * n);
    traces_.resize(n);
    constexpr std::size_t chunk = 512;
    const BlockArray::RowMatrix V = V_, B = B_;
    BlockArray::RowMatrix XV, XB;
    for (std::size_t first = 0; first < n; first += chunk) {
      const std::size_t count = std::min(chunk, n - first);
      const auto rows = blocks().all().middleRows(Eigen::Index(first) * r, Eigen::Index(count) * r);
      XV.noalias() = rows * V;
      XB.noalias() = rows * B;
      for (std::size_t i = 0; i < count; ++i) {
        const auto J = rows.middleRows(Eigen::Index(i) * r, r);
        own(first + i, 0).noalias() = XV.middleRows(Eigen::Index(i) * r, r) * J.transpose();
        own(first + i, 1).noalias() = XB.middleRows(Eigen::Index(i) * r, r) * J.transpose();
        traces_[first + i] = own(first + i, 1).trace();
      }
    }
  }

  /// D_j (which = 0) or T_j (1).
  Eigen::Map<Eigen::MatrixXd> own(std::size_t j, int which) {
    return {own_.data() + (2 * j + std::size_t(which)) * std::size_t(rows_ * rows_), rows_, rows_};
  }

  double exact_gain(int j, int k, const Eigen::MatrixXd& Yk, const Eigen::MatrixXd& Zk) {
    const Eigen::Index r = rows_;
    const auto Jj = blocks().block(std::size_t(j));
    K_.resize(2 * r, 2 * r);
    P_.resize(2 * r, 2 * r);
    cross_.noalias() = Jj * Yk;
    K_ << own(std::size_t(j), 0), cross_, cross_.transpose(), own(std::size_t(k), 0);
    K_.diagonal().head(r).array() += 1.0;
    K_.diagonal().tail(r).array() -= 1.0;
    cross_.noalias() = Jj * Zk;
    P_ << own(std::size_t(j), 1), cross_, cross_.transpose(), own(std::size_t(k), 1);
    // The new M is positive definite where det K has the sign of det S, (−1)^r; rounding at the edge is cut off.
    lu_.compute(K_);
    const double det = lu_.determinant() * (r % 2 == 0 ? 1.0 : -1.0);
    if (!(det > 1e-9)) return -infinity;
    const double left = variance_ - lu_.solve(P_).trace();
    return left > 0 ? std::log(variance_ / left) : -infinity;
  }

  Eigen::MatrixXd L_;
  const Eigen::MatrixXd* prior_;
  Eigen::Index rows_;
  Eigen::MatrixXd information_, V_, B_, K_, P_, cross_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  std::vector<double> own_, traces_;
  double variance_ = 0.0;  // φ
  bool singular_ = false;
};

/// A_t in whitened coordinates: tr(A M_raw⁻¹ Aᵀ) = tr(A_w M⁻¹ A_wᵀ), A_w = A R⁻¹.
Eigen::MatrixXd whitened(const CriterionData& data, const Eigen::MatrixXd& A) {
  Eigen::MatrixXd result = A;
  data.R.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(result);
  return result;
}

void require_test_points(const CriterionData& data) {
  if (data.test_points.empty())
    throw CannotDo("the criterion needs places where accuracy matters: set design: test_poses");
}

class WorstTestPoint : public InformationFunction {
 public:
  explicit WorstTestPoint(const CriterionData& data) {
    for (const TestPoint& t : data.test_points) points_.push_back(whitened(data, t.A));
  }

  double value(const Eigen::MatrixXd& information) const override {
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    if (!regular(factor)) return -infinity;
    return -std::log(worst(factor).second);
  }

  /// Of the point that is worst: a supergradient.
  Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const override {
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    const auto [point, variance] = worst(factor);
    const Eigen::MatrixXd half = factor.solve(points_[point].transpose());
    return half * half.transpose() / variance;
  }

  bool concave() const override { return true; }

 private:
  static bool regular(const Eigen::LLT<Eigen::MatrixXd>& factor) {
    if (factor.info() != Eigen::Success) return false;
    const Eigen::VectorXd pivots = factor.matrixLLT().diagonal();
    return pivots.minCoeff() > std::sqrt(singular_pivot) * pivots.maxCoeff();
  }

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

Eigen::MatrixXd variance_weights(const CriterionData& data) {
  const Eigen::Index m = data.R.cols();
  Eigen::MatrixXd pick = Eigen::MatrixXd::Zero(m - data.nuisance, m);
  for (Eigen::Index j = data.nuisance; j < m; ++j) pick(j - data.nuisance, j) = 1 / data.scale[j];
  const Eigen::MatrixXd A = whitened(data, pick);
  return A.transpose() * A;
}

Eigen::MatrixXd test_point_weights(const CriterionData& data) {
  require_test_points(data);
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(data.R.cols(), data.R.cols());
  double total = 0.0;
  for (const TestPoint& t : data.test_points) {
    const Eigen::MatrixXd A = whitened(data, t.A);
    L += t.weight * A.transpose() * A;
    total += t.weight;
  }
  return L / total;
}

TraceCriterion::TraceCriterion(std::string name, Eigen::MatrixXd L) : name_(std::move(name)), L_(std::move(L)) {}

std::unique_ptr<DesignState> TraceCriterion::start(const CandidateView& view, std::vector<int> members) const {
  return std::make_unique<TraceState>(view, std::move(members), L_);
}

std::unique_ptr<Criterion> make_worst_test_point_criterion(const CriterionData& data) {
  require_test_points(data);
  return std::make_unique<FunctionCriterion>("test_pose_max", std::make_shared<WorstTestPoint>(data));
}

}  // namespace posewright
