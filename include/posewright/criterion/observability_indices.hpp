#pragma once

#include <Eigen/Core>

namespace posewright {

/// O1 … O5 of a set of poses, from the singular values σ1 ≥ … ≥ σm of its scaled G.
struct ObservabilityIndices {
  double o1 = 0;  ///< (σ1 ⋯ σm)^{1/m} / √n, Borm & Menq (1991)
  double o2 = 0;  ///< σm / σ1, Driels & Pathre (1990)
  double o3 = 0;  ///< σm, Nahvi, Hollerbach & Hayward (1994)
  double o4 = 0;  ///< σm² / σ1, Nahvi & Hollerbach (1996)
  double o5 = 0;  ///< 1 / Σ(1/σi), Sun & Hollerbach (2008)
};

/// @param sigma  singular values, descending, at least one
/// @param poses  n ≥ 1; the root is over the number of parameters, n counts poses
/// A zero singular value makes every index zero.
ObservabilityIndices observability_indices(const Eigen::VectorXd& sigma, int poses);

}  // namespace posewright
