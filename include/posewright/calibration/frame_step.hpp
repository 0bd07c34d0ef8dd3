#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/score_tests.hpp"

namespace posewright {

/// A frame that stands elsewhere from one pose on: the tracker was pushed, the tool slipped.
struct FrameStep {
  std::string frame;  ///< name of its effect
  int before = 0;     ///< ids of the last pose before the step and of the first one after it
  int after = 0;
  double share = 0.0;   ///< of the squared residuals that the step explains
  double chance = 1.0;  ///< that noise alone gives as much at the best place of all
};

/// The step that explains most of the residuals; none: none explains more than half of them beyond chance (1 %).
/// Score tests of each frame's displacement from pose k on, for all k with three poses before and three behind, with p
/// for as many (Bonferroni).
/// @param columns  what was fitted
/// @param poses    of one file, in its order
/// @param frames   whose parameters the model's catalogue has
std::optional<FrameStep> frame_step(const IdentificationModel& model, const VariantColumns& columns,
                                    const std::vector<MeasuredPose>& poses, const Fit& fit,
                                    const std::vector<EffectToTest>& frames);

}  // namespace posewright
