#include "posewright/model/whitening.hpp"

#include "posewright/blocks/block_array.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

void factorise_covariance(Linearisation& scratch) {
  scratch.factor.compute(scratch.covariance);
  if (scratch.factor.info() != Eigen::Success)
    throw CannotDo("measurement: the noise covariance is not positive definite");
}

}  // namespace

bool whitened_block(const IdentificationModel& model, std::span<const double> q, std::span<const double> correction,
                    std::span<const int> selected, Linearisation& scratch, double* out, int stride) {
  const Eigen::Index rows = model.block_rows(selected);
  BlockArray::Map block(out, rows, Eigen::Index(selected.size()), Eigen::OuterStride<>(stride));
  if (rows < model.rows()) {
    // G = B C: L⁻¹ B = Q R, and Q turns rows only.
    if (!model.linearise_factored(q, correction, selected, scratch)) return false;
    factorise_covariance(scratch);
    scratch.factor.matrixL().solveInPlace(scratch.basis);
    scratch.compression.compute(scratch.basis);
    const auto& r = scratch.compression.matrixQR();
    for (Eigen::Index i = 0; i < rows; ++i) {
      block.row(i) = r(i, i) * scratch.coefficients.row(i);
      for (Eigen::Index k = i + 1; k < rows; ++k) block.row(i) += r(i, k) * scratch.coefficients.row(k);
    }
    return true;
  }
  if (!model.linearise(q, correction, selected, scratch)) return false;
  factorise_covariance(scratch);
  // Forward substitution by rows: the block is row-major and G may be overwritten row by row.
  const auto& l = scratch.factor.matrixLLT();
  for (Eigen::Index i = 0; i < block.rows(); ++i) {
    block.row(i) = scratch.G.row(i);
    for (Eigen::Index k = 0; k < i; ++k)
      if (l(i, k) != 0) block.row(i) -= l(i, k) * block.row(k);
    block.row(i) /= l(i, i);
  }
  return true;
}

}  // namespace posewright
