#pragma once

#include "posewright/model/tip_model.hpp"
#include "posewright/problem/measurement_specs.hpp"

namespace posewright {

/// How many twists a visit's displacement of the tip has: 0, 3 (a translation) or 6 (a rotation about the tip, too).
int displacement_size(const Repeatability& repeatability);

/// What stays at a pose for the whole visit: the tip stands off by a random twist e, the same for all that is read
/// there, so that the readings' covariance is A Σ_e Aᵀ with A the readings' derivative along the twists of the tip.
/// Fills `twists` (6 × displacement_size()) with the columns of Σ_e^{1/2} as spatial twists in M: translation·(axis,
/// 0), rotation·(p × axis, axis).
/// @param p  origin of the tip in M, m
void displacement_of_a_visit(const Repeatability& repeatability, const Eigen::Vector3d& p, Eigen::Ref<Twists> twists);

}  // namespace posewright
