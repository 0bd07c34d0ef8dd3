#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/planning/configuration_space.hpp"
#include "posewright/study/space.hpp"

namespace posewright {

/// Bound of the sensitivity of these parts' blocks, one form for each choice of the discrete axes. Everything
/// referred to must outlive it.
/// @param R  blocks are J_raw R⁻¹
HarmonicForms harmonic_forms_of(const std::vector<SpacePart>& parts, const std::vector<ConfigurationSpace::Axis>& axes,
                                const Eigen::MatrixXd& R, const WeightedConfigurations& where);

}  // namespace posewright
