#pragma once

#include <memory>

#include "posewright/criterion/information_function.hpp"

namespace posewright {

/// A bound of log det(M0 + S) for S of rank at most L < m that is tighter than log det itself where S is only relaxed,
/// S = Σ n_i J_iᵀJ_i. With the eigenvalues λ of W = (M0 + εI)^{-1/2} S (M0 + εI)^{-1/2} in falling order,
///   Γ = log det(M0 + εI) + Σ_{i ≤ k} ln(1 + λ_i) + (L − k) ln(1 + t),  t = Σ_{i > k} λ_i / (L − k),  λ_k > t ≥
///   λ_{k+1}:
/// the largest Σ ln(1 + μ_i) of any L numbers μ that majorise λ, so concave in S, and equal to log det(M0 + εI + S)
/// where S has rank L. Nikolov (2015), STOC '15, for M0 = 0; Li, Fampa, Lee, Qiu, Xie & Yao (2024), Operations Research
/// 72(5), for the fusion of data.
class RankLimitedLogDet {
 public:
  /// @param known  M0, m × m, positive semidefinite; any ε > 0 is valid, the bound is loose by about ε tr (M0 + S)⁻¹
  RankLimitedLogDet(const Eigen::MatrixXd& known, double ridge, int rank);
  /// The value is Γ plus what rounding may have taken from it; T Tᵀ = ∂Γ/∂S.
  std::unique_ptr<Expansion> expand(const Eigen::MatrixXd& added) const;

 private:
  Eigen::MatrixXd to_white_;  // (M0 + εI)^{-1/2} as L⁻ᵀ
  double log_det_;
  int rank_;
};

}  // namespace posewright
