#include "posewright/criterion/spectral.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "posewright/support/dense.hpp"
#include "product_curvature.hpp"
#include "spectral_state.hpp"

namespace posewright {
namespace {

// Ratio of eigenvalues of the whitened, scaled information below which it counts as singular.
constexpr double singular_ratio = 1e-15;
// Least Cholesky pivot of the nuisance block, scaled to a unit diagonal, from which swaps keep their digits.
constexpr double safely_eliminated = 1e-5;

// o3 is curved by the mean (Σ λ⁻ᵖ)^{−1/p} in place of the least eigenvalue: larger is nearer and harder to solve.
constexpr double smoothing = 60.0;
// Under which o3 is settled first, the last of them at the beginning.
constexpr std::array<double, 3> smooth_powers = {16, 4, 1};
// Pairs of eigenvectors whose products are held at a time.
constexpr Eigen::Index pairs_at_once = 4096;

/// Φ = −ln(Σ λ⁻ᵖ)/2p of the eigenvalues of the Schur complement, p = ½ for o5. For o3 p is large, and value and T are
/// those of o3 itself with the supergradient that the weights λ^{−p−1} give: λ_s ≤ ⟨Z, M⟩ for every Z of trace 1.
class SpectralExpansion : public Expansion {
 public:
  /// @param left  C W V: columns that the eigenvalues are squares of;  @param inside  L_nn⁻ᵀ of the nuisance columns
  SpectralExpansion(bool of_all, double power, const Eigen::VectorXd& lambda, Eigen::MatrixXd left,
                    Eigen::MatrixXd inside)
      : p_(of_all ? power : smoothing), least_(lambda[0]), inside_(std::move(inside)) {
    mu_ = lambda / least_;
    sum_ = mu_.array().pow(-p_).sum();
    left_ = left / std::sqrt(least_);
    const Eigen::ArrayXd weight = mu_.array().pow(-p_ - 1);
    share_ = 0.5 * weight / (of_all ? sum_ : weight.sum());
    value = 0.5 * std::log(least_) - (of_all ? std::log(sum_) / (2 * p_) : 0.0);
    factor = upper_factor(left_ * share_.cwiseSqrt().asDiagonal());
  }

  /// Daleckii–Krein: D² Σ λ⁻ᵖ [X, Y] = Σ_ab f'[λ_a, λ_b] X_ab Y_ab with f' = −p λ^{−p−1} and its divided differences;
  /// and what the elimination of nuisance columns curves besides.
  void curvature(const BlockArray::RowMatrix& rows, int r, Eigen::MatrixXd& H) const override {
    const BlockArray::RowMatrix Y = rows * left_;
    const Eigen::Index count = rows.rows() / r;
    // As T's, where the weights of o3 sum to one.
    const double scale = share_.sum() / (0.5 * mu_.array().pow(-p_ - 1).sum() / sum_);
    Eigen::VectorXd d(count);
    for (Eigen::Index i = 0; i < count; ++i)
      d[i] = (Y.middleRows(i * r, r).array().square().matrix() * share_).sum() / scale;
    if (inside_.cols() > 0)
      product_curvature(rows.leftCols(inside_.rows()) * inside_, Y * (share_ / scale).cwiseSqrt().asDiagonal(), r, H);
    else H.setZero(count, count);
    add_pairs(Y, r, H);
    H.selfadjointView<Eigen::Lower>().rankUpdate(d, -2 * p_);
    H.triangularView<Eigen::StrictlyUpper>() = H.transpose();
    H *= scale;
  }

 private:
  /// The sum over pairs of eigenvectors, lower triangle.
  void add_pairs(const BlockArray::RowMatrix& Y, int r, Eigen::MatrixXd& H) const {
    const Eigen::Index s = Y.cols(), count = Y.rows() / r;
    Eigen::MatrixXd products(count, std::min(pairs_at_once, s * (s + 1) / 2));
    Eigen::Index held = 0;
    const auto add = [&] {
      H.selfadjointView<Eigen::Lower>().rankUpdate(products.leftCols(held));
      held = 0;
    };
    for (Eigen::Index b = 0; b < s; ++b)
      for (Eigen::Index a = 0; a <= b; ++a) {
        const double weight = std::sqrt((a == b ? 1.0 : 2.0) * difference(a, b) / (2 * p_ * sum_));
        for (Eigen::Index i = 0; i < count; ++i)
          products(i, held) = weight * Y.col(a).segment(i * r, r).dot(Y.col(b).segment(i * r, r));
        if (++held == products.cols()) add();
      }
    if (held > 0) add();
  }

  double difference(Eigen::Index a, Eigen::Index b) const {
    const double x = mu_[a], y = mu_[b];
    if (std::abs(x - y) < 1e-5 * (x + y)) return p_ * (p_ + 1) * std::pow(0.5 * (x + y), -p_ - 2);
    return -p_ * (std::pow(x, -p_ - 1) - std::pow(y, -p_ - 1)) / (x - y);
  }

  double p_, least_, sum_ = 0.0;
  Eigen::VectorXd mu_, share_;  // eigenvalues in units of the least; ∂Φ/∂λ in the same
  Eigen::MatrixXd left_, inside_;
};

}  // namespace

double SpectralFunction::value(const Eigen::MatrixXd& information) const {
  const Spectrum s = spectrum(information, false);
  return s.regular ? of(s.lambda) : -std::numeric_limits<double>::infinity();
}

Eigen::MatrixXd SpectralFunction::gradient(const Eigen::MatrixXd& information) const {
  const Spectrum s = spectrum(information, true);
  const Eigen::MatrixXd left = directions(s);
  return left * by_eigenvalue(s.lambda).asDiagonal() * left.transpose();
}

std::unique_ptr<Expansion> SpectralFunction::expand(const Eigen::MatrixXd& information) const {
  const Spectrum s = spectrum(information, true);
  Eigen::MatrixXd within;
  if (!s.regular || !inside(information, within)) return nullptr;
  return std::make_unique<SpectralExpansion>(of_all(), power_, s.lambda, directions(s), std::move(within));
}

bool SpectralFunction::inside(const Eigen::MatrixXd& information, Eigen::MatrixXd& result) const {
  result.resize(0, 0);
  if (nuisance_ == 0) return true;
  const Eigen::MatrixXd N = C_.leftCols(nuisance_);
  const Eigen::LLT<Eigen::MatrixXd> factor(N.transpose() * information * N);
  if (factor.info() != Eigen::Success) return false;
  result = N.topRows(nuisance_) * factor.matrixL().solve(Eigen::MatrixXd::Identity(nuisance_, nuisance_)).transpose();
  return true;
}

SpectralFunction::Spectrum SpectralFunction::spectrum(const Eigen::MatrixXd& information, bool with_vectors) const {
  const Eigen::MatrixXd M = C_.transpose() * information * C_;
  const Eigen::Index m = M.cols(), n = nuisance_, s = m - n;
  Spectrum result;
  Eigen::MatrixXd schur = M.bottomRightCorner(s, s);
  Eigen::MatrixXd eliminated(n, s);
  if (n > 0) {
    // Nuisance columns have units of their own: scale before judging pivots.
    const Eigen::VectorXd unit = M.topLeftCorner(n, n).diagonal().cwiseSqrt().cwiseInverse();
    if (!unit.allFinite()) return result;
    const Eigen::LLT<Eigen::MatrixXd> factor(unit.asDiagonal() * M.topLeftCorner(n, n) * unit.asDiagonal());
    if (factor.info() != Eigen::Success) return result;
    eliminated = unit.asDiagonal() * factor.solve(unit.asDiagonal() * M.topRightCorner(n, s));
    schur -= M.bottomLeftCorner(s, n) * eliminated;
    result.eliminated = factor.matrixLLT().diagonal().minCoeff() > safely_eliminated;
  } else {
    result.eliminated = true;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      schur, with_vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
  result.lambda = eigen.eigenvalues();
  result.regular = result.lambda[0] > singular_ratio * result.lambda[s - 1];
  if (!with_vectors) return result;
  result.vectors = eigen.eigenvectors();
  result.W.resize(m, s);
  result.W << -eliminated, Eigen::MatrixXd::Identity(s, s);
  return result;
}

double SpectralFunction::of(const Eigen::VectorXd& lambda) const {
  const double least = lambda[0], most = lambda[lambda.size() - 1];
  if (!(least > singular_ratio * most)) return -std::numeric_limits<double>::infinity();
  if (index_ == SpectralIndex::o2) return 0.5 * std::log(least / most);
  if (index_ == SpectralIndex::o3) return 0.5 * std::log(least);
  if (index_ == SpectralIndex::o4) return std::log(least / std::sqrt(most));
  return mean(lambda);
}

double SpectralFunction::mean(const Eigen::VectorXd& lambda) const {
  const double least = lambda.minCoeff();
  return 0.5 * std::log(least) - std::log((lambda / least).array().pow(-power_).sum()) / (2 * power_);
}

Eigen::VectorXd SpectralFunction::by_eigenvalue(const Eigen::VectorXd& lambda) const {
  if (of_all()) {
    const Eigen::ArrayXd weight = (lambda / lambda[0]).array().pow(-power_);
    return 0.5 * weight / (lambda.array() * weight.sum());
  }
  const Eigen::Index last = lambda.size() - 1;
  Eigen::VectorXd d = Eigen::VectorXd::Zero(lambda.size());
  d[0] += (index_ == SpectralIndex::o4 ? 1.0 : 0.5) / lambda[0];
  if (index_ != SpectralIndex::o3) d[last] -= 0.5 / lambda[last];
  return d;
}

namespace {

class SpectralCriterion : public Criterion {
 public:
  SpectralCriterion(std::string name, SpectralIndex index, const CriterionData& data)
      : name_(std::move(name)), function_(std::make_shared<SpectralFunction>(index, data)) {
    if (index == SpectralIndex::o3) smoother_.reset(new SpectralCriterion(data, 0));
  }
  std::string name() const override { return name_; }
  const InformationFunction& function() const override { return *function_; }
  const Criterion* smoother() const override { return smoother_.get(); }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override {
    return start_spectral(view, std::move(members), function_);
  }

 private:
  /// Exponents of the means that lead to o3, and of the smoother ones behind it.
  SpectralCriterion(const CriterionData& data, std::size_t step)
      : name_("o3 smoothed"),
        function_(std::make_shared<SpectralFunction>(SpectralIndex::mean, data, smooth_powers[step])) {
    if (step + 1 < smooth_powers.size()) smoother_.reset(new SpectralCriterion(data, step + 1));
  }

  std::string name_;
  std::shared_ptr<const SpectralFunction> function_;
  std::unique_ptr<SpectralCriterion> smoother_;
};

}  // namespace

std::unique_ptr<Criterion> make_spectral_criterion(SpectralIndex index, const CriterionData& data) {
  static constexpr std::array<const char*, 4> names = {"o2", "o3", "o4", "o5"};
  return std::make_unique<SpectralCriterion>(names[std::size_t(index)], index, data);
}

}  // namespace posewright
