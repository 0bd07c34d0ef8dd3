#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/unmodelled_effect.hpp"
#include "posewright/planning/configuration_space.hpp"
#include "posewright/workspace/candidates.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {

/// One model's share of a block: its rows and columns follow those of the parts before.
struct SpacePart {
  const IdentificationModel* model;
  const Workspace* workspace;
  std::vector<int> selected;
  Eigen::MatrixXd mix;                       ///< blocks are J(selected) · mix; empty: J(selected)
  const EffectFeatures* features = nullptr;  ///< in front of the selected ones; null: none
};

/// The problem's workspace as planners see it. Everything referred to must outlive it.
/// @param measured  poses that are there already or fixed: new ones keep the spacing from them
/// @param R  whitening of all columns: blocks are J_raw R⁻¹
std::unique_ptr<ConfigurationSpace> make_configuration_space(std::vector<SpacePart> parts,
                                                             const Configurations& candidates,
                                                             const Configurations& measured, const Spacing& spacing,
                                                             Eigen::MatrixXd R);

}  // namespace posewright
