#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

// Weights of more candidates than this are settled at a gap that no figure shows: a step costs the cube of their
// number.
inline constexpr std::size_t most_settled = 1200;
inline constexpr double settled_gap = 1e-6;
/// A bound with the rounding of the pass behind it, generously.
double with_margin(double bound);
/// A first working set of `size` of n candidates, half of which are given, the strong ones: the rest is a draw from
/// every stretch of the array, which makes M regular (an even stride would meet the period of a grid). Ascending.
std::vector<int> with_drawn(std::vector<int> strong, std::size_t n, std::size_t size);

/// Primal-dual interior-point method for the approximate design problem on a working set of candidates:
///   max Φ(M(w)),  Σw = 1,  0 ≤ w ≤ cap,
/// with multipliers z ≥ 0 of w ≥ 0, y ≥ 0 of w ≤ cap and λ of Σw = 1. Optimality: d(w) − λ + z − y = 0. d and the
/// Newton matrix come from Φ's expansion (criterion/information_function.hpp).
class RestrictedDesign {
 public:
  /// @param prior  information per unit of weight, M(w) = prior + Σ w_i J_iᵀJ_i; empty: none
  RestrictedDesign(const BlockArray& blocks, const InformationFunction& function, double cap,
                   const Eigen::MatrixXd& prior);

  /// New working set; candidates already in it keep their weight, new ones enter with a small one.
  /// Returns false if they leave M(w) singular; the set is then of no use.
  bool set_candidates(const std::vector<int>& candidates);
  /// Newton steps until the optimality gap on the working set, relative to Φ's degree, is at
  /// most `gap`. Returns the number of steps. Ends early where the best weights leave M singular, and
  /// where the monitor says stop.
  int solve(double gap, const Monitor& monitor);

  const std::vector<int>& candidates() const { return candidates_; }
  const Eigen::VectorXd& weights() const { return w_; }
  double price() const { return lambda_; }
  double value() const { return expansion_->value; }
  /// Share of the prior in Σ w_i d_i + tr(S prior) = degree; 0 without one.
  double prior_sensitivity() const { return prior_sensitivity_; }
  /// T of S = T Tᵀ, for the pass over all candidates.
  const Eigen::MatrixXd& factor() const { return expansion_->factor; }

 private:
  bool expand();
  BlockArray::RowMatrix stacked() const;
  bool capped() const { return cap_ < 1.0; }
  double complementarity() const;
  double gap() const;
  bool newton_step(double mu);

  const BlockArray& blocks_;
  const InformationFunction& function_;
  double degree_;
  double cap_;
  const Eigen::MatrixXd& prior_;
  std::vector<int> candidates_;
  Eigen::VectorXd w_, z_, y_, d_;
  double lambda_ = 0.0, prior_sensitivity_ = 0.0;
  std::unique_ptr<Expansion> expansion_;
  BlockArray::RowMatrix rows_;  ///< of the working set
  Eigen::MatrixXd hessian_;
};

}  // namespace posewright
