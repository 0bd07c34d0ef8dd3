#pragma once

#include <Eigen/Core>
#include <memory>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"
#include "posewright/criterion/information_function.hpp"

namespace posewright {

/// Functions of the singular values σ1 ≥ … ≥ σs of the scaled G with nuisance eliminated (theory.md eq. (18)):
///   o2 = σs/σ1 (Driels & Pathre 1990), o3 = σs (Nahvi et al. 1994), o4 = σs²/σ1 (Nahvi & Hollerbach 1996),
///   o5 = 1/Σ σi⁻¹ (Sun & Hollerbach 2008).
/// The search maximises the logarithm. They depend on the scale of the columns. ln o3 and ln o5 are concave in M and
/// bounded (squared, both are matrix means of degree 1: Pukelsheim 2006, Optimal Design of Experiments, 6.7); o2 and o4
/// are not.
/// `mean` stands between: (Σ λᵢ⁻ᵖ)^{−1/2p}, o5 at p = ½ and o3 for p → ∞. o3 is first settled under it.
enum class SpectralIndex { o2, o3, o4, o5, mean };

/// Φ of the eigenvalues λ = σ², ascending, of the scaled information with nuisance eliminated.
class SpectralFunction : public InformationFunction {
 public:
  /// @param power  p of `mean`; of no account elsewhere
  SpectralFunction(SpectralIndex index, const CriterionData& data, double power = 0.5)
      : index_(index), power_(power), nuisance_(data.nuisance), C_(data.to_scaled()) {}

  double value(const Eigen::MatrixXd& information) const override;
  /// ∂Φ/∂M = C W (Σ_i ∂Φ/∂λ_i v_i v_iᵀ) Wᵀ Cᵀ: the Schur complement is Wᵀ M_s W with W = [−M_nn⁻¹ M_ni; I], and W's own
  /// change does not count, because it minimises.
  Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const override;
  bool concave() const override { return has_bound(); }
  double degree() const override { return has_bound() ? 0.5 : 0.0; }
  std::unique_ptr<Expansion> expand(const Eigen::MatrixXd& information) const override;

  struct Spectrum {
    Eigen::VectorXd lambda;
    Eigen::MatrixXd vectors, W;
    bool eliminated = false;  ///< whether the nuisance columns are determined
    bool regular = false;
  };
  Spectrum spectrum(const Eigen::MatrixXd& information, bool with_vectors) const;
  /// C W V: a block times this are its rows in the eigenvectors' directions.
  Eigen::MatrixXd directions(const Spectrum& s) const { return C_ * s.W * s.vectors; }
  /// C_n L⁻ᵀ, M_nn = L Lᵀ of the nuisance columns: (J times this) squared is J_n M_nn⁻¹ J_nᵀ. No columns if there are
  /// none; false if M_nn is singular.
  bool inside(const Eigen::MatrixXd& information, Eigen::MatrixXd& result) const;
  /// ln of o2 … o5; −∞ where singular.
  double of(const Eigen::VectorXd& lambda) const;
  /// −ln(Σ λ⁻ᵖ)/2p of positive λ in any order.
  double mean(const Eigen::VectorXd& lambda) const;
  /// ∂Φ/∂λ_i, λ ascending.
  Eigen::VectorXd by_eigenvalue(const Eigen::VectorXd& lambda) const;
  SpectralIndex index() const { return index_; }
  /// True if every eigenvalue counts: Φ = −ln(Σ λ⁻ᵖ)/2p.
  bool of_all() const { return index_ == SpectralIndex::o5 || index_ == SpectralIndex::mean; }
  /// Blocks times this are in units of the scale.
  const Eigen::MatrixXd& to_scaled() const { return C_; }
  int nuisance() const { return nuisance_; }

 private:
  bool has_bound() const { return index_ == SpectralIndex::o3 || of_all(); }

  SpectralIndex index_;
  double power_;
  int nuisance_;
  Eigen::MatrixXd C_;
};

std::unique_ptr<Criterion> make_spectral_criterion(SpectralIndex index, const CriterionData& data);

}  // namespace posewright
