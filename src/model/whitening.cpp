#include "posewright/model/whitening.hpp"

#include <cmath>

#include "posewright/blocks/block_array.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

[[noreturn]] void refuse_covariance() { throw CannotDo("measurement: the noise covariance is not positive definite"); }

/// Divides rows of `block` by the lower triangle l, row by row: the block is row-major.
template <class Block, class Triangle>
void forward_substitute(const Triangle& l, Block& block) {
  for (Eigen::Index i = 0; i < block.rows(); ++i) {
    for (Eigen::Index k = 0; k < i; ++k)
      if (l(i, k) != 0) block.row(i) -= l(i, k) * block.row(k);
    block.row(i) /= l(i, i);
  }
}

/// G = B C, covariance Σ + B N Nᵀ Bᵀ: with L⁻¹ B = Q R (Σ = L Lᵀ; Q turns rows only) the block is
/// (I + R N Nᵀ Rᵀ)^{-1/2} R C, so that the cost grows with the readings r linearly.
void whiten_factored(Linearisation& s, BlockArray::Map& block) {
  if (s.covariance.isDiagonal(0.0)) {
    if (!(s.covariance.diagonal().minCoeff() > 0)) refuse_covariance();
    for (Eigen::Index i = 0; i < s.basis.rows(); ++i) s.basis.row(i) /= std::sqrt(s.covariance(i, i));
  } else {
    factorise_covariance(s.covariance, s.factor);
    s.factor.matrixL().solveInPlace(s.basis);
  }
  s.compression.compute(s.basis);
  const auto& r = s.compression.matrixQR();
  s.rows.resize(block.rows(), s.random_coefficients.cols());
  for (Eigen::Index i = 0; i < block.rows(); ++i) {
    block.row(i) = r(i, i) * s.coefficients.row(i);
    s.rows.row(i) = r(i, i) * s.random_coefficients.row(i);
    for (Eigen::Index k = i + 1; k < block.rows(); ++k) {
      block.row(i) += r(i, k) * s.coefficients.row(k);
      s.rows.row(i) += r(i, k) * s.random_coefficients.row(k);
    }
  }
  if (s.rows.cols() == 0) return;
  s.small.resize(block.rows(), block.rows());
  s.small.noalias() = s.rows.lazyProduct(s.rows.transpose());
  s.small.diagonal().array() += 1.0;
  s.small_factor.compute(s.small);
  forward_substitute(s.small_factor.matrixLLT(), block);
}

}  // namespace

void factorise_covariance(const Eigen::MatrixXd& covariance, Eigen::LLT<Eigen::MatrixXd>& factor) {
  factor.compute(covariance);
  if (factor.info() != Eigen::Success) refuse_covariance();
}

bool whitened_block(const IdentificationModel& model, std::span<const double> q, std::span<const double> correction,
                    std::span<const int> selected, Linearisation& scratch, double* out, int stride) {
  const Eigen::Index rows = model.block_rows(selected);
  BlockArray::Map block(out, rows, Eigen::Index(selected.size()), Eigen::OuterStride<>(stride));
  if (rows < model.rows()) {
    if (!model.linearise_factored(q, correction, selected, scratch)) return false;
    whiten_factored(scratch, block);
    return true;
  }
  if (!model.linearise(q, correction, selected, scratch)) return false;
  factorise_covariance(scratch.covariance, scratch.factor);
  block = scratch.G;
  forward_substitute(scratch.factor.matrixLLT(), block);
  return true;
}

/// Theory.md eq. (48). With J = Uᵀ G, U Uᵀ = Σ⁻¹ on the rows' span: ∂f/∂G = U ∂f/∂J, ∂f/∂Σ = −½ U (∂f/∂J Jᵀ) Uᵀ; the
/// product is symmetric, for f does not change if the rows of J are turned.
bool whitened_gradient(const IdentificationModel& model, std::span<const double> q, std::span<const int> selected,
                       const BlockArray::RowMatrix& block, const BlockArray::RowMatrix& slope, Linearisation& scratch,
                       std::span<double> gradient) {
  static thread_local Eigen::MatrixXd U, by_G, by_covariance, turned;
  const Eigen::Index width = block.rows();
  U.setIdentity(model.rows(), width);
  if (width < model.rows()) {
    if (scratch.random_coefficients.cols() > 0) scratch.small_factor.matrixU().solveInPlace(U.topRows(width));
    U.applyOnTheLeft(scratch.compression.householderQ());
    if (scratch.covariance.isDiagonal(0.0))
      U = scratch.covariance.diagonal().cwiseSqrt().cwiseInverse().asDiagonal() * U;
    else scratch.factor.matrixU().solveInPlace(U);
  } else {
    scratch.factor.matrixU().solveInPlace(U);
  }
  turned.noalias() = slope * block.transpose();
  by_G.noalias() = U * slope;
  by_covariance.noalias() = -0.25 * U * (turned + turned.transpose()) * U.transpose();
  return model.pull_back(q, selected, by_G, by_covariance, gradient);
}

}  // namespace posewright
