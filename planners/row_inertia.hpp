#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// Necessary conditions on single rows v_1 … v_L for M0 + Σ v_iᵀv_i ⪰ t I: more than the same for numbers of rows
/// that need not be whole. With G = V (t I − M0)⁻¹ Vᵀ − I and e eigenvalues of M0 below t, G has exactly s = L − e
/// negative eigenvalues (Haynsworth 1968, inertia of a matrix and its Schur complements); theory.md eq. (60), (61).
/// Rounding is inside: what reaches t is never ruled out.
class RowInertia {
 public:
  using RowMatrix = BlockArray::RowMatrix;

  /// False: no L of these rows, each at most room[i] times, reach t.
  /// @param known  M0, m × m, positive semidefinite
  /// @param rows   f × m, those that may be chosen
  bool look(const Eigen::MatrixXd& known, const RowMatrix& rows, const Eigen::VectorXd& room, int left,
            double threshold);

  /// s; 0: every row lifts an eigenvalue to t, and none may be taken twice.
  int slack() const { return slack_; }
  /// True if row i may be in a set that reaches t.
  bool possible(Eigen::Index i) const { return possible_[std::size_t(i)] != 0; }
  /// Bounds for possible rows: b ≥ 0 with Σ b_i ≤ s over what reaches t, b_i = max(0, 1 − v_i D v_iᵀ), D the positive
  /// part of (t I − M0)⁻¹.
  const Eigen::VectorXd& shortfall() const { return shortfall_; }
  /// Rows of which s at most are in what reaches t: no more of them can be, as G of s + 1 would be negative definite.
  /// Those of large `weight` are taken first, and those alone that may be taken no more than once.
  const std::vector<int>& exclusive(const Eigen::VectorXd& weight, const Eigen::VectorXd& room);

 private:
  void project(const Eigen::MatrixXd& known, const RowMatrix& rows, double threshold);
  bool settle_pairs(const Eigen::VectorXd& room, int left);
  bool settle_partners(const Eigen::VectorXd& room, int left);
  bool enough_classes(int left) const;
  int partners_after(Eigen::Index i, const Eigen::VectorXd& room) const;
  bool excludes(Eigen::Index i, Eigen::Index j) const;
  bool extends_factor(int row);

  int slack_ = 0;
  RowMatrix projected_, weighted_;
  Eigen::VectorXd own_;       // v_i (t I − M0)⁻¹ v_iᵀ
  Eigen::VectorXd rounding_;  // what rounding may have changed in it
  Eigen::VectorXd shortfall_;
  Eigen::MatrixXd products_;  // v_i (t I − M0)⁻¹ v_jᵀ
  std::vector<char> possible_;
  std::vector<std::uint64_t> compatible_;  // where s = 0: bits of the rows that may stand beside row i
  std::size_t words_ = 0;
  std::vector<int> order_, exclusive_;
  Eigen::MatrixXd factor_;
};

}  // namespace posewright
