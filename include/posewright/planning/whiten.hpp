#pragma once

#include <Eigen/Core>
#include <functional>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// Upper triangular R of X_raw = X R; see whiten().
struct Whitening {
  Eigen::MatrixXd R;      ///< m × m
  Eigen::MatrixXd prior;  ///< R⁻ᵀ prior R⁻¹; empty without one

  /// log det of the interest information in raw coordinates minus that in whitened ones.
  double log_det_offset(int nuisance) const;
};

/// Replaces every block J by J R⁻¹ so that Σ JᵀJ / n = I over the whole array. R is triangular: the leading k columns
/// keep their span, so Schur complements only gain a constant factor. Two passes of Cholesky QR on columns scaled to
/// unit length (Yamamoto et al. 2015, ETNA 44): orthogonal to machine precision for condition numbers up to about 1e8.
/// Throws CannotDo if the columns are linearly dependent.
/// With a prior (information per pose) Σ JᵀJ / n + prior becomes I, so that candidates need not tell everything.
Whitening whiten(BlockArray& blocks, const Eigen::MatrixXd& prior = {});

/// Variant for m columns of blocks at any place.
/// @param gram   Σ JᵀJ / n, its lower triangle
/// @param solve  replaces every J by J r⁻¹, r upper triangular
Whitening whiten(int columns, const std::function<Eigen::MatrixXd()>& gram,
                 const std::function<void(const Eigen::MatrixXd& r)>& solve, const Eigen::MatrixXd& prior);

}  // namespace posewright
