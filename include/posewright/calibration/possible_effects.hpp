#pragma once

#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Size τ of an effect that the model lacks and factor s of the stated noise, with the probability of both.
struct PossibleSize {
  double effect = 0.0;  ///< τ, 1σ along each axis, m
  double noise = 1.0;   ///< s
  double probability = 0.0;
};

/// Sizes of an effect of one shape. All shapes together have probability one.
struct PossibleEffects {
  UnmodelledSize shape;  ///< of τ = 1 m; translation 0: the readings contain no tip, and only the noise is unknown
  std::vector<PossibleSize> sizes;
};

/// Distribution of the size of a missing effect, given the residuals at the model's own values, theory.md eq. (66):
/// restricted likelihood of (τ, s) for smooth effects over 20, 60 and 160 deg, without and with a turn of the
/// tip, with a flat prior in ln τ from 0.5 to 16 times the noise of a pose and in ln s from 1 on. Poses that leave no
/// degree of freedom return the prior. Of more than 80 poses that many count, evenly through the list.
/// @param columns  estimated
/// Throws CannotDo if a pose is out of reach.
std::vector<PossibleEffects> possible_effects(const IdentificationModel& model, const VariantColumns& columns,
                                              const std::vector<MeasuredPose>& poses);

}  // namespace posewright
