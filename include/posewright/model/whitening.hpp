#pragma once

#include <span>

#include "posewright/blocks/block_array.hpp"
#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Cholesky factor of a residual's covariance. Throws CannotDo if that is not positive definite.
void factorise_covariance(const Eigen::MatrixXd& covariance, Eigen::LLT<Eigen::MatrixXd>& factor);

/// Whitened block J = L⁻¹ G with covariance = L Lᵀ of the residual, i.e. J = W^{1/2} ∂g/∂ξ up to a rotation of the
/// rows, W = (G_y Σ_y G_yᵀ + G_ρ Σ_ρ G_ρᵀ)⁻¹; JᵀJ = Gᵀ W G. Written row-major, r rows of selected.size() doubles,
/// `stride` doubles apart. Does not allocate once `scratch` has been used with the same sizes.
/// @return false if q is unreachable; nothing is written then
/// Throws CannotDo if the covariance is not positive definite.
bool whitened_block(const IdentificationModel& model, std::span<const double> q, std::span<const double> correction,
                    std::span<const int> selected, Linearisation& scratch, double* out, int stride);

/// Gradient of a number that depends on a configuration through JᵀJ alone, along every continuous coordinate.
/// @param block    J as whitened_block() wrote it for q
/// @param slope    r × selected: the number's derivative by J there
/// @param scratch  as whitened_block() left it at q
/// @param gradient  size coordinates(); undefined for choices
/// @return false if the model does not know its derivatives
bool whitened_gradient(const IdentificationModel& model, std::span<const double> q, std::span<const int> selected,
                       const BlockArray::RowMatrix& block, const BlockArray::RowMatrix& slope, Linearisation& scratch,
                       std::span<double> gradient);

}  // namespace posewright
