#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// Σ_i weights(k, i) n_i ≤ most[k] for every row k of the weights, which are not negative.
struct NumberLimits {
  Eigen::MatrixXd weights;
  Eigen::VectorXd most;
};

/// max s over numbers that need not be whole, M0 + Σ n_i J_iᵀJ_i ⪰ s P, 0 ≤ n_i ≤ room_i, Σ n_i = L, and limits; P is
/// the identity on the columns of interest. Primal-dual interior-point method with the direction of Helmberg, Rendl,
/// Vanderbei & Wolkowicz (1996, SIAM J. Optim. 6(2)): a few steps a node where the barrier of EigenvalueRelaxation
/// takes dozens. Whatever the method did, the dual matrix E ⪰ 0 of trace 1 on P bounds what designs reach (theory.md
/// eq. (44)). Keeps its memory from one problem to the next.
class EigenvalueProgram {
 public:
  using RowMatrix = BlockArray::RowMatrix;

  /// @param r         rows of a block
  /// @param nuisance  leading columns that do not count in P
  EigenvalueProgram(int r, int nuisance) : r_(r), nuisance_(nuisance) {}

  /// False if the information of the numbers is singular.
  /// @param rows     f·r × m, kept by the caller until the last step; nuisance columns first
  /// @param known    M0, m × m
  /// @param numbers  of each of the f blocks, Σ = L; moved into the interior
  bool begin(const RowMatrix& rows, const Eigen::MatrixXd& known, const Eigen::VectorXd& room,
             const NumberLimits& limits, const Eigen::VectorXd& numbers);
  /// One step; false if rounding ends it.
  bool step();

  /// s: numbers() reach more, if they meet the limits.
  double reached() const { return least_; }
  bool within_limits() const;
  const Eigen::VectorXd& numbers() const { return n_; }
  /// tr(J_i E J_iᵀ) of every block, and tr(E M0).
  const Eigen::VectorXd& shares() const { return shares_; }
  double known_share() const { return known_share_; }
  /// Multipliers of the limits in units of E.
  const Eigen::VectorXd& prices() const { return prices_; }

 private:
  bool factorise();
  bool take_dual();
  void curvature();
  void direction(double target);
  void advance();
  double complementarity() const;
  void sum_weighted(const Eigen::VectorXd& weights, Eigen::MatrixXd& sum);

  Eigen::Index r_, nuisance_, m_ = 0, f_ = 0;
  const RowMatrix* rows_ = nullptr;
  const Eigen::MatrixXd* known_ = nullptr;
  const NumberLimits* limits_ = nullptr;
  Eigen::VectorXd room_, n_, low_, high_, left_, limit_price_;  // low_, high_: multipliers of 0 ≤ n and n ≤ room
  double least_ = 0.0;
  Eigen::MatrixXd shifted_, inverse_, dual_;  // M − s P, its inverse, E not yet normalised
  Eigen::MatrixXd inverse_root_, dual_root_;  // L⁻ᵀ of M − s P = L Lᵀ; L of E = L Lᵀ
  Eigen::LLT<Eigen::MatrixXd> shifted_factor_, dual_factor_, factor_;
  Eigen::VectorXd shares_, prices_;
  double known_share_ = 0.0, dual_trace_ = 1.0;
  RowMatrix inverse_rows_, dual_rows_, weighted_;
  Eigen::MatrixXd hessian_, solution_, inverse_tile_, dual_tile_, mixed_;
  Eigen::VectorXd inverse_shares_, mixed_shares_;
  Eigen::VectorXd d_n_, d_low_, d_high_, d_left_, d_price_;
  Eigen::MatrixXd d_shifted_, d_dual_, trial_;
  double d_least_ = 0.0;
};

}  // namespace posewright
