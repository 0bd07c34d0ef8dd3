#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/unmodelled_effect.hpp"
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

}  // namespace posewright
