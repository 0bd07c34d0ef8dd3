#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Optimal weights on candidates, Σw = 1, and what they prove.
struct ApproximateDesign {
  std::vector<int> support;     ///< candidates with positive weight, ascending
  std::vector<double> weights;  ///< one per support candidate
  double value = 0.0;           ///< Φ(M(w)), or what its bound starts from (see maximin)
  /// Mean of the largest d_i over the candidates (one for no cap, N where w ≤ 1/N) divided by Φ's degree; ≥ 1, and 1 at
  /// the optimum (Kiefer & Wolfowitz 1960).
  double max_sensitivity_ratio = 1.0;
  double bound = 0.0;      ///< upper bound of Φ over all feasible weights
  double degree = 0.0;     ///< of Φ
  Eigen::MatrixXd factor;  ///< T of d(q) = ‖J(q) T‖² at w: sensitivity of any configuration, not only candidates
  double price = 0.0;      ///< multiplier of Σw = 1: candidates with d_i well below it are in no good plan
  std::vector<double> sensitivity;  ///< d_i of every candidate at w
  int rounds = 0, newton_steps = 0;
  bool stopped = false;  ///< the monitor stopped it; the bound is valid all the same

  /// Support points of significant weight: starts for weights of nearly the same candidates.
  std::vector<int> weighted() const;
  /// Upper bound of Φ over all exact plans of `poses` poses: M of N poses is N times that of weights k_i/N.
  double bound_for(int poses) const;
};

/// Largest Σ v_i value_i over 0 ≤ v ≤ cap, Σv = 1: the largest values, each up to the cap, the last one in part.
double best_mean(std::vector<double> value, double cap);

/// Options of solve_approximate_design.
struct ApproximateDesignOptions {
  double cap = 1.0;         ///< w_i ≤ cap; 1/N where an exact plan of N poses may not repeat one
  double tolerance = 1e-9;  ///< stop at max_sensitivity_ratio ≤ 1 + tolerance
  int max_rounds = 200;
  int threads = 1;  ///< for the passes over all candidates; 0 = all
  /// Information known before, per unit of weight (that of a plan of N poses divided by N), in the blocks' coordinates;
  /// empty: none. It counts as if every candidate carried it too, so everything above holds with d_i + its own share.
  Eigen::MatrixXd prior{};
  /// Candidates on which most of the weight is expected, ascending: the first working set if they are enough. It
  /// changes how long the solution takes and nothing else. Empty: none are known.
  std::vector<int> start{};
};

/// Maximises Φ of M(w) = Σ w_i J_iᵀJ_i over 0 ≤ w ≤ cap, Σw = 1.
///
/// Column generation: a primal-dual interior-point method solves the problem on a working set of candidates; one
/// full pass gives the sensitivity d_i = tr(J_i S J_iᵀ), S = ∂Φ/∂M, of every candidate; violators enter. The pass is
/// also the proof: e^{Φ/h} is concave and of degree one, h being Φ's degree, so for every feasible v, Φ(v) ≤ Φ(w) + h
/// ln(Σ v_i d_i / h), and Σ v_i d_i is at most the mean of the 1/cap largest d_i.
///
/// @param blocks    whitened (see whiten())
/// @param function  of positive degree
/// Throws std::invalid_argument if cap · n < 1 or Φ has no degree, CannotDo if no weights give a regular M.
ApproximateDesign solve_approximate_design(const BlockArray& blocks, const InformationFunction& function,
                                           const ApproximateDesignOptions& options, const Monitor& monitor);

}  // namespace posewright
