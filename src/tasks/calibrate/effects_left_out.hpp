#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "posewright/calibration/score_tests.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// The model that was fitted, of a problem that says more.
using ModelMaker = std::function<std::unique_ptr<IdentificationModel>(const Problem&)>;

/// Score tests of unfitted effects: every other parameter of the robot's catalogue,
/// eccentricity of every joint of a serial arm, and what other variants of the file estimate beyond this one. Empty for
/// fits that do not weigh readings by their covariance.
std::vector<ScoreTest> effects_left_out(const ProblemVariant& variant, const IdentificationModel& fitted_model,
                                        const VariantColumns& fitted, const std::vector<MeasuredPose>& poses,
                                        const Fit& fit, const ModelMaker& model_of);

}  // namespace posewright
