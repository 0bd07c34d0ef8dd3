#pragma once

#include <Eigen/Dense>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// Primal-dual interior-point method for the approximate design problem on a working set of candidates:
///   max log det S(M(w)),  Σw = 1,  0 ≤ w ≤ cap,
/// with multipliers z ≥ 0 of w ≥ 0, y ≥ 0 of w ≤ cap and λ of Σw = 1. Optimality: d(w) − λ + z − y = 0.
/// Newton matrix of −log det S: H_ij = ‖J_i M⁻¹ J_jᵀ‖²_F less the same of the nuisance block, positive semidefinite.
class RestrictedDesign {
 public:
  /// @param prior  information per unit of weight, M(w) = prior + Σ w_i J_iᵀJ_i; empty: none
  RestrictedDesign(const BlockArray& blocks, int nuisance, double cap, const Eigen::MatrixXd& prior);

  /// New working set; candidates already in it keep their weight, new ones enter with a small one.
  /// Returns false where they leave M(w) singular; the set is then of no use.
  bool set_candidates(const std::vector<int>& candidates);
  /// Newton steps until the optimality gap on the working set, relative to the number of interest parameters, is at
  /// most `gap`. Returns the number of steps. Throws CannotDo where M(w) is singular.
  int solve(double gap);

  const std::vector<int>& candidates() const { return candidates_; }
  const Eigen::VectorXd& weights() const { return w_; }
  double price() const { return lambda_; }
  double log_det() const { return log_det_; }
  /// What the prior has of Σ w_i d_i + tr(prior part) = number of interest parameters; 0 without one.
  double prior_sensitivity() const { return prior_sensitivity_; }
  /// L⁻¹ of M(w) = L Lᵀ, for the pass over all candidates.
  const Eigen::MatrixXd& inverse_factor() const { return inverse_factor_; }

 private:
  bool factorise();
  void fill_hessian();
  bool capped() const { return cap_ < 1.0; }
  double complementarity() const;
  double gap() const;
  void newton_step(double mu);

  const BlockArray& blocks_;
  int nuisance_, interest_;
  double cap_;
  const Eigen::MatrixXd& prior_;
  std::vector<int> candidates_;
  Eigen::VectorXd w_, z_, y_, d_;
  double lambda_ = 0.0, log_det_ = 0.0, prior_sensitivity_ = 0.0;
  Eigen::MatrixXd inverse_factor_;
  BlockArray::RowMatrix rotated_;  ///< rows J_i L⁻ᵀ of the working set
  Eigen::MatrixXd hessian_;
};

}  // namespace posewright
