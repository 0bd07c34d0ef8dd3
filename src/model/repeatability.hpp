#pragma once

#include "posewright/model/tip_model.hpp"
#include "posewright/problem/measurement_specs.hpp"

namespace posewright {

/// The tip's unit displacements as spatial twists in M: along its axes (k = 0, 1, 2), about them through p (3, 4, 5).
/// @param p  origin of the tip in M, m
Twist unit_displacement(const Eigen::Vector3d& p, int k);

/// Number of twists of a visit's displacement of the tip: 0, 3 (a translation) or 6 (a rotation about the tip, too).
int displacement_size(const Repeatability& repeatability);

/// Repeatability: the tip is displaced by a random twist e for the whole visit, equal for all readings
/// there, so that the readings' covariance is A Σ_e Aᵀ with A the readings' derivative along the twists of the tip.
/// Fills `twists` (6 × displacement_size()) with the columns of Σ_e^{1/2} as spatial twists in M.
/// @param p  origin of the tip in M, m
void displacement_of_a_visit(const Repeatability& repeatability, const Eigen::Vector3d& p, Eigen::Ref<Twists> twists);

}  // namespace posewright
