#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kernels/kernels.hpp"
#include "posewright/criterion/inverse_information.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"

namespace posewright {

// Removing a block that carries (almost) all information about some direction: 1 − λmax(D_k) below this.
inline constexpr double indispensable = 1e-8;
// A running inverse is computed afresh after so many changes.
inline constexpr int changes_till_refresh = 40;

inline double log_det_positive(const Eigen::MatrixXd& a, Eigen::LLT<Eigen::MatrixXd>& factor) {
  factor.compute(a);
  if (factor.info() != Eigen::Success) return -infinity;
  return 2 * factor.matrixLLT().diagonal().array().log().sum();
}

/// The part of a swap that depends on the leaving block k alone, and the gain of any entering block j:
///   ln det(M − J_kᵀJ_k + J_jᵀJ_j) − ln det M = ln det(I − D_k) + ln det(I + D_j + C (I − D_k)⁻¹ Cᵀ),  C = J_j V J_kᵀ,
/// or, where I − D_k is singular, = ln det(I + D_j) + ln det(I − D_k + Cᵀ (I + D_j)⁻¹ C).
class SwapGain {
 public:
  SwapGain(const InverseInformation& inverse, int rows)
      : inverse_(inverse), rows_(rows), d_k_(rows, rows), c_(rows, rows), d_j_(rows, rows), work_(rows, rows) {}

  /// Call whenever the inverse has changed: what is remembered of it is void.
  void forget() { ++version_; }

  void leave(int k) {
    inverse_.project(k, y_);
    inverse_.cross(k, y_, d_k_);
    d_leaving_ = inverse_.trace(k);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(d_k_);
    slack_ = 1 - eigen.eigenvalues().maxCoeff();
    regular_ = slack_ > indispensable;
    half_ = y_;
    if (!regular_) return;
    const Eigen::VectorXd rest = 1 - eigen.eigenvalues().array();
    leave_log_det_ = rest.array().log().sum();
    // Rows V J_kᵀ (I − D_k)^{-1/2}: J_j times these, squared, is C (I − D_k)⁻¹ Cᵀ.
    const Eigen::Index stride = inverse_.blocks().stride();
    Eigen::Map<BlockArray::RowMatrix>(half_.data(), rows_, stride).noalias() =
        (eigen.eigenvectors() * rest.cwiseSqrt().cwiseInverse().asDiagonal()).transpose() *
        Eigen::Map<const BlockArray::RowMatrix>(y_.data(), rows_, stride);
  }

  /// ln det(I + D_j).
  double addition(int j) {
    inverse_.own(j, scratch_, d_j_);
    d_j_.diagonal().array() += 1;
    return log_det_positive(d_j_, factor_);
  }
  /// ln det(I − D_k); −∞ where k is indispensable.
  double removal(int k) {
    inverse_.own(k, scratch_, d_j_);
    d_j_ = -d_j_;
    d_j_.diagonal().array() += 1;
    const double change = log_det_positive(d_j_, factor_);
    return change < rows_ * std::log(indispensable) ? -infinity : change;
  }

  /// Next candidate from `first` on and before `end` that may gain more than `wanted`, by bounds that cost r² dot
  /// products. With A = D_j + C (I − D_k)⁻¹ Cᵀ: gain = ln det(I − D_k) + ln det(I + A) ≤ ln det(I − D_k) + r ln(1 + tr
  /// A/r), A ≼ D_j/(1 − λmax(D_k)), and no swap gains more than adding alone.
  std::size_t next(std::size_t first, std::size_t end, double wanted, const std::vector<unsigned char>& blocked) const {
    const std::vector<double>& d = inverse_.traces();
    const double alone = rows_ * std::expm1(wanted / rows_);
    const double both = regular_ ? rows_ * std::expm1((wanted - leave_log_det_) / rows_) : 0.0;
    // Φ is concave: no swap gains more than its derivative promises.
    double least = std::max(d_leaving_ + wanted, alone);
    if (regular_) least = std::max(least, slack_ * both);
    const BlockArray& blocks = inverse_.blocks();
    return kernels().next_block(blocks.data(), first, end, rows_, blocks.stride(), half_.data(), rows_, d.data(),
                                blocked.data(), least, regular_ ? both : -infinity);
  }

  /// Exact gain.
  double exact(int j) {
    own(j);
    if (regular_) {
      inverse_.cross(j, half_, c_);
      work_.noalias() = c_ * c_.transpose();
      work_ += d_j_;
      work_.diagonal().array() += 1;
      return leave_log_det_ + log_det_positive(work_, factor_);
    }
    inverse_.cross(j, y_, c_);
    d_j_.diagonal().array() += 1;
    const double added = log_det_positive(d_j_, factor_);
    work_ = c_;
    factor_.matrixL().solveInPlace(work_);
    d_j_.noalias() = work_.transpose() * work_ - d_k_;
    d_j_.diagonal().array() += 1;
    return added + log_det_positive(d_j_, factor_);
  }

 private:
  /// D_j from the last time it was asked for since the inverse changed: near a local optimum every position asks for
  /// the same few.
  void own(int j) {
    if (rows_ == 1) {
      inverse_.own(j, scratch_, d_j_);
      return;
    }
    if (remembered_.empty()) {
      remembered_.resize(remembered_count * std::size_t(rows_ * rows_));
      whose_.assign(remembered_count, {-1, 0});
    }
    const std::size_t slot = std::size_t(j) % remembered_count;
    Eigen::Map<Eigen::MatrixXd> kept(remembered_.data() + slot * std::size_t(rows_ * rows_), rows_, rows_);
    if (whose_[slot] != std::pair{j, version_}) {
      inverse_.own(j, scratch_, d_j_);
      kept = d_j_;
      whose_[slot] = {j, version_};
    } else {
      d_j_ = kept;
    }
  }

  static constexpr std::size_t remembered_count = 2048;
  const InverseInformation& inverse_;
  int rows_;
  long version_ = 0;
  std::vector<double> remembered_;
  std::vector<std::pair<int, long>> whose_;  // candidate and version of each slot
  std::vector<double> y_, half_, scratch_;
  Eigen::MatrixXd d_k_, c_, d_j_, work_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double slack_ = 0, leave_log_det_ = 0, d_leaving_ = 0;
  bool regular_ = true;
};

}  // namespace posewright
