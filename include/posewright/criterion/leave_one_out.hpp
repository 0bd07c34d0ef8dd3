#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

struct SingleMatrix;

/// Exact gains of log det of the interest information (Schur complement) when one member leaves and a candidate enters,
/// from a fresh factor of what remains: with M₋ = M − J_kᵀJ_k = L Lᵀ, nuisance columns first, and Z = J_j L⁻ᵀ,
///   ln det S(M₋ + J_jᵀJ_j) = ln det S(M₋) + ln det(I + Z Zᵀ) − ln det(I + Z_n Z_nᵀ),
/// Z_n being the leading columns of Z: one product serves both determinants. Costs O(m³) per leaving member and
/// O(r m²) per candidate asked for; needs no running inverse, so nothing drifts.
class LeaveOneOut {
 public:
  LeaveOneOut(const BlockArray& blocks, int nuisance, const Eigen::MatrixXd* prior);

  /// Σ JᵀJ over the members. Returns false if it is singular.
  bool set_members(const std::vector<int>& members);
  /// −1 for nobody, here and below.
  void exchange(int leave, int enter);
  /// ln det S(M) now; −∞ where singular.
  double value() const { return value_; }
  /// Variant with a ridge for a singular M: the reference of gains.
  double reference() const { return reference_; }
  /// d of the interest information for candidate j, from a fresh factor of M.
  double sensitivity(int j) const;
  /// d of every candidate at most, from single precision; computed when it is first asked for.
  const std::vector<double>& sensitivity_bounds() const;

  /// Prepares gains for a leaving member. Where M or M₋ is singular a small ridge is added; while M is, it is in both
  /// sides of a gain, so that accepted swaps still rise monotonically.
  void leave(int k);
  /// Φ(after) − Φ(now) for candidate j in the place of the member left out.
  double gain(int j) const;
  /// No less than gain(j), in a fraction of its time.
  double gain_bound(int j) const;
  /// Next candidate from `first` on whose gain may be more than `wanted`; the number of candidates if there is none.
  /// With what is left M₋ and A = I + Z_n Z_nᵀ ⪰ I: gain ≤ Φ(M₋) − Φ(M) + r ln(1 + d₋/r), d₋ = tr(Z Zᵀ) − tr(Z_n Z_nᵀ),
  /// which a change of rank r gives from the sensitivities d of M; Φ is concave, so gain ≤ d_j − d_k; and no swap gains
  /// more than adding alone, r ln(1 + d_j/r).
  std::size_t next(std::size_t first, double wanted, const std::vector<unsigned char>& blocked) const;
  /// Φ of the design with j in the place of k, from scratch.
  double exact(int k, int j) const;

 private:
  /// A matrix in single precision, and what rounding adds to its products with rows of length 1 (SingleMatrix).
  struct SingleCopy {
    std::vector<float> data;
    int rows = 0, columns = 0;
    double error = 0;
    void set(const Eigen::MatrixXd& matrix);
    SingleMatrix view(int leading) const;
  };

  void factorise();
  void prepare_bound(int k, bool regular);
  void tile();
  Eigen::MatrixXd swapped(int leave, int enter) const;

  const BlockArray& blocks_;
  const Eigen::MatrixXd* prior_;  ///< null: none
  int nuisance_, padded_nuisance_, tiles_;
  Eigen::MatrixXd information_, inverse_factor_, rest_factor_;  ///< L⁻¹ of M, and of M₋ without who leaves
  double value_ = 0.0;
  double reference_ = 0.0;  ///< value_, or that of M plus ridge where M is singular
  double without_ = 0.0;
  double leaving_sensitivity_ = 0.0;  ///< d of the member left out; 0 for nobody
  bool has_bound_ = false;
  SingleCopy half_, nuisance_half_;  ///< M⁻¹J_kᵀ(I − D_k)^{−T/2}, and the same of the nuisance columns
  std::vector<double> t_, size_;     ///< columns of rest_factor_ as the kernel takes them; ‖J‖ of each candidate
  mutable std::vector<double> scratch_;
  mutable std::vector<float> single_scratch_;
  mutable std::vector<double> d_;
  mutable bool d_is_of_now_ = false;
  std::vector<int> tile_rows_;
};

}  // namespace posewright
