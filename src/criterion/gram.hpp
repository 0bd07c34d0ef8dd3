#pragma once

#include "kernels/kernels.hpp"
#include "posewright/blocks/block_array.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {

/// Rows that kernels().gram takes: as many columns as asked for, and zeros up to a multiple of 8.
inline BlockArray::RowMatrix padded_rows(Eigen::Index rows, Eigen::Index columns) {
  return BlockArray::RowMatrix::Zero(rows, (columns + 7) / 8 * 8);
}

/// H = X Xᵀ of padded rows.
inline void gram(const BlockArray::RowMatrix& X, Eigen::MatrixXd& H) {
  H.resize(X.rows(), X.rows());
  kernels().gram(X.data(), std::size_t(X.rows()), int(X.cols()), H.data());
  H.triangularView<Eigen::StrictlyUpper>() = H.transpose();
}

/// Variant for rows without padding.
template <class Rows>
void gram_of(const Rows& X, Eigen::MatrixXd& H) {
  BlockArray::RowMatrix padded = padded_rows(X.rows(), X.cols());
  padded.leftCols(X.cols()) = X;
  gram(padded, H);
}

}  // namespace posewright
