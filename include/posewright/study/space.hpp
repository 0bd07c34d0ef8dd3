#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "posewright/planning/configuration_space.hpp"
#include "posewright/workspace/candidates.hpp"
#include "posewright/workspace/space_part.hpp"

namespace posewright {

/// The problem's workspace as planners see it. Everything referred to must outlive it.
/// @param measured  poses that are there already or fixed: new ones keep the spacing from them
/// @param R  whitening of all columns: blocks are J_raw R⁻¹
std::unique_ptr<ConfigurationSpace> make_configuration_space(std::vector<SpacePart> parts,
                                                             const Configurations& candidates,
                                                             const Configurations& measured, const Spacing& spacing,
                                                             Eigen::MatrixXd R);

}  // namespace posewright
