#pragma once

#include "gram.hpp"
#include "posewright/blocks/block_array.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {

/// H_ij = 2 tr(X_i S_A X_j S) where every block's rows are given as Z = J L⁻ᵀ (S_A = L⁻ᵀL⁻¹) and G = J F (S = F Fᵀ):
/// the product ⟨P_i, P_j⟩, P = ZᵀG. Returns d_i = tr(X_i S) = ‖G_i‖².
/// @param r  rows of one block; H is resized
inline Eigen::VectorXd product_curvature(const BlockArray::RowMatrix& Z, const BlockArray::RowMatrix& G, int r,
                                         Eigen::MatrixXd& H) {
  const Eigen::Index s = Z.rows() / r, size = Z.cols() * G.cols();
  Eigen::VectorXd d(s);
  for (Eigen::Index i = 0; i < s; ++i) d[i] = G.middleRows(i * r, r).squaredNorm();
  if (r == 1) {
    Eigen::MatrixXd second;
    gram_of(Z, H);
    gram_of(G, second);
    H = 2 * H.cwiseProduct(second);
    return d;
  }
  BlockArray::RowMatrix products = padded_rows(s, size);
  for (Eigen::Index i = 0; i < s; ++i)
    BlockArray::Map(products.row(i).data(), Z.cols(), G.cols(), Eigen::OuterStride<>(G.cols())).noalias() =
        Z.middleRows(i * r, r).transpose() * G.middleRows(i * r, r);
  gram(products, H);
  H *= 2.0;
  return d;
}

}  // namespace posewright
