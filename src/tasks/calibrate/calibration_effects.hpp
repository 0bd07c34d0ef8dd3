#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "calibration_verdict.hpp"

namespace posewright {

/// The model that was fitted, of a problem that says more.
using ModelMaker = std::function<std::unique_ptr<IdentificationModel>(const Problem&)>;

/// Score tests of unfitted effects: every other parameter of the robot's catalogue,
/// eccentricity of every joint of a serial arm, and what other variants of the file estimate beyond this one. Empty for
/// fits that do not weigh readings by their covariance.
std::vector<ScoreTest> effects_left_out(const ProblemVariant& variant, const IdentificationModel& fitted_model,
                                        const VariantColumns& fitted, const std::vector<MeasuredPose>& poses,
                                        const Fit& fit, const ModelMaker& model_of);

/// Base and what is on the tip, as effects.
std::vector<EffectToTest> frames_that_may_move(const MeasurementSpec& measurement, const IdentificationModel& model);

/// A smooth effect that the residuals show: fills `smooth`, and for a variant that has one `counted`.
/// @return what a fit must count; null: nothing
std::shared_ptr<const UnmodelledEffect> effect_to_count(const ProblemVariant& variant, const CalibratedPoses& poses,
                                                        Calibration& result);

/// Residuals interpolated between the poses.
/// @param effect  that the fit counts; null: none
Interpolation interpolation_of(const VariantSpec& variant, const CalibratedPoses& poses,
                               const std::shared_ptr<const UnmodelledEffect>& effect, const Calibration& result);

}  // namespace posewright
