#pragma once

#include <memory>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/tip_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Robot and instrument of a problem file as one variant sees them: its convention of parameters, its nominal values.
/// Throws InputError (URDF, limits, names) or CannotDo (instrument, robot and variant do not fit).
std::unique_ptr<IdentificationModel> make_model(const ProblemVariant& variant);

/// Overload for the problem's first variant.
std::unique_ptr<IdentificationModel> make_model(const Problem& problem);

/// The problem without errors common to a pose (the robot's repeatability, its joint readings' noise).
Problem without_pose_errors(Problem problem);

/// The robot alone; null for one that carries no single tip. Throws as make_model.
std::unique_ptr<TipModel> make_tip(const ProblemVariant& variant);

}  // namespace posewright
