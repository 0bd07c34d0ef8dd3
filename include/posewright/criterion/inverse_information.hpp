#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// Reduction of X V Xᵀ by a change of M, with candidates of one row each as X: Σ_l signs[l] terms_l terms_lᵀ.
struct RankChange {
  Eigen::MatrixXd terms;     ///< n × number of terms
  Eigen::VectorXd signs;     ///< 1 or −1
  Eigen::VectorXd entering;  ///< X V x_enterᵀ before the change as a combination of the terms
};

/// Running V = M⁻¹ of the leading `columns` columns of a design's blocks, M = Σ J_iᵀJ_i (+ ridge), together with
/// d_j = tr(J_j V J_jᵀ) of every candidate j. Updated by rank 2r (Sherman–Morrison–Woodbury), refreshed by Cholesky.
class InverseInformation {
 public:
  /// @param threads  for the passes over all candidates, ≥ 1
  InverseInformation(const BlockArray& blocks, int columns, const Eigen::MatrixXd* prior, int threads = 1);

  /// From scratch. Returns false (and leaves everything untouched) where M is not safely positive definite.
  bool refresh(const std::vector<int>& members, double ridge);
  double log_det() const { return log_det_; }
  double trace(int candidate) const { return d_[std::size_t(candidate)]; }
  const std::vector<double>& traces() const { return d_; }
  int columns() const { return columns_; }
  /// V, columns × columns.
  Eigen::Map<const BlockArray::RowMatrix, 0, Eigen::OuterStride<>> inverse() const {
    return {v_.data(), columns_, columns_, Eigen::OuterStride<>(stride_)};
  }
  const BlockArray& blocks() const { return blocks_; }

  /// Y = V J_candidateᵀ as r rows of `stride` doubles (zero beyond `columns`).
  void project(int candidate, std::vector<double>& y) const;
  /// J_candidate Yᵀ: r × r, Y from project().
  void cross(int candidate, const std::vector<double>& y, Eigen::MatrixXd& c) const;
  /// D_candidate = J V Jᵀ, r × r.
  /// @param y  room for Y
  void own(int candidate, std::vector<double>& y, Eigen::MatrixXd& d) const;
  /// d of a candidate whose block is another one now.
  void measure(int candidate);
  /// M ← M − J_leaveᵀJ_leave + J_enterᵀJ_enter; −1 for nobody. Returns false if the update would lose all accuracy:
  /// nothing has changed then and the caller refreshes instead.
  /// @param made  blocks of one row: receives the change; null: not needed
  bool change(int leave, int enter, RankChange* made = nullptr);
  /// M ← M + JᵀJ of a candidate in V and log_det() alone: d of before bounds d of now from above, until refresh() or
  /// measure().
  bool add(int candidate);

 private:
  bool update(int leave, int enter);
  void take_from_traces();
  void take_from_traces(RankChange& made);

  const BlockArray& blocks_;
  const Eigen::MatrixXd* prior_;  ///< null: none
  int columns_, stride_, rows_, threads_;
  std::vector<double> v_;  ///< columns × stride, row-major
  std::vector<double> d_;
  double log_det_ = 0.0;
  std::vector<double> y_, scratch_;   ///< 2r × stride
  Eigen::MatrixXd own_;               ///< r × r
  BlockArray::RowMatrix products_;    ///< n × 2
  BlockArray::RowMatrix directions_;  ///< of the last change: V ← V − Σ_l sign_l direction_lᵀ direction_l
  Eigen::VectorXd sign_, entering_;
};

}  // namespace posewright
