#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// Interior-point method for numbers of poses that need not be whole:
///   max λ_min(S(n)) − t λ_max(S(n)),  S(n) the Schur complement of the nuisance columns of M0 + Σ n_i J_iᵀJ_i,
///   0 ≤ n_i ≤ room_i, Σ n_i = N.
/// Its dual is a bound at every iterate, whatever the method did before: for E, F ⪰ 0, tr E = tr F = 1 (E on the
/// interest block),
///   λ_min − t λ_max ≤ tr(M0 (E − tF)) + Σ of the N largest tr(J_i (E − tF) J_iᵀ)            (theory.md eq. (45)).
/// Barrier method (Boyd & Vandenberghe 2004, 11.8): E and F are the normalised inverses of M − s P and L I − M. With
/// t = 0 there is no F; t > 0 asks for no nuisance columns: λ_max of a Schur complement has no such bound.
class EigenvalueRelaxation {
 public:
  using RowMatrix = BlockArray::RowMatrix;

  /// @param rows      f·r × m, in the scale that the eigenvalues are meant in; nuisance columns first
  /// @param known     M0, m × m
  /// @param numbers   of each of the f candidates, Σ = N; moved into the interior
  /// @param with_ratio  whether t may be positive later
  EigenvalueRelaxation(RowMatrix rows, int r, int nuisance, Eigen::MatrixXd known, Eigen::VectorXd room,
                       const Eigen::VectorXd& numbers, bool with_ratio);

  /// False if the information of the numbers is singular: nothing below may be called then.
  bool regular() const { return regular_; }
  /// One Newton step towards the centre, and the next μ once near it. False if rounding ends it.
  bool step(double t);
  /// s/L, no more than λ_min/λ_max of numbers().
  double ratio() const { return least_ / most_; }
  /// s: below λ_min of numbers().
  double least() const { return least_; }
  /// Possible rise of the objective at the present μ.
  double gap() const;

  const Eigen::VectorXd& numbers() const { return n_; }
  /// Factors of E and F: E = left leftᵀ, m × m.
  Eigen::MatrixXd least_factor() const;
  Eigen::MatrixXd most_factor() const;

 private:
  bool factorise(const Eigen::VectorXd& n, double least, double most);
  void products();

  RowMatrix rows_;
  Eigen::Index r_, nuisance_, m_, f_;
  Eigen::MatrixXd known_;
  Eigen::VectorXd room_, n_;
  bool with_ratio_, regular_ = false;
  double least_ = 0.0, most_ = 0.0, mu_ = 1.0;
  Eigen::MatrixXd information_, hessian_;
  Eigen::LLT<Eigen::MatrixXd> low_, high_;  ///< of M − s P and L I − M
  Eigen::LLT<Eigen::MatrixXd> factor_;      ///< of the curvature
  Eigen::VectorXd gradient_, change_;
  RowMatrix scaled_, mixed_;  ///< work space, as the next ones: what a step needs is as large as all rows
  Eigen::MatrixXd shifted_, tile_;
};

}  // namespace posewright
