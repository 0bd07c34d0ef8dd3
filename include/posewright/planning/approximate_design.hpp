#pragma once

#include <Eigen/Dense>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Optimal weights on candidates, Σw = 1, and what they prove.
struct ApproximateDesign {
  std::vector<int> support;     ///< candidates with positive weight, ascending
  std::vector<double> weights;  ///< one per support candidate
  double log_det = 0.0;         ///< Φ(w) = log det of the interest information M(w)
  /// Mean of the largest d_i over the candidates (one for no cap, N where w ≤ 1/N) divided by the number of
  /// interest parameters; ≥ 1, and 1 at the optimum (Kiefer & Wolfowitz 1960).
  double max_sensitivity_ratio = 1.0;
  double log_det_bound = 0.0;       ///< upper bound of Φ over all feasible weights
  double price = 0.0;               ///< multiplier of Σw = 1: candidates with d_i well below it are in no good plan
  std::vector<double> sensitivity;  ///< d_i of every candidate at w
  int rounds = 0, newton_steps = 0;
  bool stopped = false;  ///< the monitor stopped it; the bound is valid all the same

  /// Upper bound of Φ over all exact plans of `poses` poses with `interest` parameters: M of N poses is N times that of
  /// weights k_i/N.
  double log_det_bound_for(int poses, int interest) const;
};

/// Options of solve_approximate_design.
struct ApproximateDesignOptions {
  double cap = 1.0;         ///< w_i ≤ cap; 1/N where an exact plan of N poses may not repeat one
  double tolerance = 1e-9;  ///< stop at max_sensitivity_ratio ≤ 1 + tolerance
  int max_rounds = 200;
  /// Information known before, per unit of weight (that of a plan of N poses divided by N), in the blocks' coordinates;
  /// empty: none. It counts as if every candidate carried it too, so everything above holds with d_i + its own share.
  Eigen::MatrixXd prior;
};

/// Maximises log det of the interest information of M(w) = Σ w_i J_iᵀJ_i over 0 ≤ w ≤ cap, Σw = 1.
///
/// Column generation: a primal-dual interior-point method solves the problem on a working set of candidates; one
/// full pass gives the sensitivity d_i = tr(J_i M⁻¹ J_iᵀ) − tr(J_i,n M_nn⁻¹ J_i,nᵀ) of every candidate; violators
/// enter. The pass is also the proof: Φ is the logarithm of a concave function of degree s (Schur complement
/// determinant, s interest parameters), so for every feasible v, Φ(v) ≤ Φ(w) + s ln(Σ v_i d_i / s), and Σ v_i d_i
/// is at most the mean of the 1/cap largest d_i.
///
/// @param blocks    whitened (see whiten())
/// @param nuisance  number of leading nuisance columns
/// Throws std::invalid_argument where cap · n < 1, CannotDo where no weights give a regular M.
ApproximateDesign solve_approximate_design(const BlockArray& blocks, int nuisance,
                                           const ApproximateDesignOptions& options, const Monitor& monitor);

}  // namespace posewright
