#pragma once

#include <Eigen/Core>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// Estimate by least squares from the readings X₂.
struct AliasFit {
  Eigen::MatrixXd taken;     ///< alias matrix, own × (columns − own), in the units of the columns
  Eigen::VectorXd residual;  ///< squared length of what is left of each column of X₂, that of the knowledge included
};
/// Alias matrix A = (X₁ᵀX₁)⁻¹X₁ᵀX₂ (Box & Draper; theory.md eq. (24)): where the readings hold X₂ δ that the fitted
/// columns X₁ know nothing of, least squares gives their parameters A δ too much. By QR on columns of unit length; no
/// inverse is formed.
/// @param blocks  whitened; the leading `own` columns are those that are fitted, the rest X₂
/// @param known   1σ of what is known before of each fitted column, its estimate held to zero so far; empty: nothing
/// Throws std::invalid_argument for sizes that do not fit, CannotDo if the fitted columns are dependent.
AliasFit fit_aliases(const BlockArray& blocks, int own, const Eigen::VectorXd& known = {});

}  // namespace posewright
