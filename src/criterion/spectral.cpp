#include "posewright/criterion/spectral.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// Ratio of eigenvalues of the whitened, scaled information below which it counts as singular.
constexpr double singular_ratio = 1e-15;

class SpectralFunction : public InformationFunction {
 public:
  SpectralFunction(SpectralIndex index, const CriterionData& data)
      : index_(index), nuisance_(data.nuisance), C_(data.to_scaled()) {}

  double value(const Eigen::MatrixXd& information) const override {
    const Spectrum s = spectrum(information, false);
    return s.regular ? std::log(of(s.lambda)) : -std::numeric_limits<double>::infinity();
  }

  /// ∂Φ/∂M = C W (Σ_i ∂Φ/∂λ_i v_i v_iᵀ) Wᵀ Cᵀ: the Schur complement is Wᵀ M_s W with W = [−M_nn⁻¹ M_ni; I], and W's own
  /// change does not count, because it minimises.
  Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const override {
    const Spectrum s = spectrum(information, true);
    const Eigen::MatrixXd left = C_ * s.W * s.vectors;
    return left * by_eigenvalue(s.lambda).asDiagonal() * left.transpose();
  }

  bool concave() const override { return index_ == SpectralIndex::o3; }

 private:
  struct Spectrum {
    Eigen::VectorXd lambda;  // σ², ascending
    Eigen::MatrixXd vectors, W;
    bool regular = false;
  };

  Spectrum spectrum(const Eigen::MatrixXd& information, bool with_vectors) const {
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

  double of(const Eigen::VectorXd& lambda) const {
    const double least = lambda[0], most = lambda[lambda.size() - 1];
    if (index_ == SpectralIndex::o2) return std::sqrt(least / most);
    if (index_ == SpectralIndex::o3) return std::sqrt(least);
    if (index_ == SpectralIndex::o4) return least / std::sqrt(most);
    return 1 / lambda.cwiseSqrt().cwiseInverse().sum();
  }

  /// ∂ ln Φ / ∂λ_i.
  Eigen::VectorXd by_eigenvalue(const Eigen::VectorXd& lambda) const {
    if (index_ == SpectralIndex::o5) return 0.5 * of(lambda) * lambda.array().pow(-1.5);
    const Eigen::Index last = lambda.size() - 1;
    Eigen::VectorXd d = Eigen::VectorXd::Zero(lambda.size());
    d[0] += (index_ == SpectralIndex::o4 ? 1.0 : 0.5) / lambda[0];
    if (index_ != SpectralIndex::o3) d[last] -= 0.5 / lambda[last];
    return d;
  }

  SpectralIndex index_;
  int nuisance_;
  Eigen::MatrixXd C_;
};

}  // namespace

std::unique_ptr<Criterion> make_spectral_criterion(SpectralIndex index, const CriterionData& data) {
  static constexpr std::array<const char*, 4> names = {"o2", "o3", "o4", "o5"};
  return std::make_unique<FunctionCriterion>(names[std::size_t(index)],
                                             std::make_shared<SpectralFunction>(index, data));
}

}  // namespace posewright
