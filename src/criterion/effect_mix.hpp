#pragma once

#include "posewright/criterion/criterion_data.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

inline void require_effects(const CriterionData& data) {
  if (data.effects.columns == 0)
    throw CannotDo("the criterion needs an alternative model to test: set design: truth or --truth");
}

/// Mix of the trailing columns in whitened coordinates: effects are J_f mix = (J_f,w R_ff + J_a,w R_af) mix.
inline Eigen::MatrixXd whitened_mix(const CriterionData& data) {
  const Eigen::Index k = data.effects.columns;
  return data.R.bottomRightCorner(k, k) * data.effects.mix;
}

}  // namespace posewright
