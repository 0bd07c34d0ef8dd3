#pragma once

#include "posewright/calibration/conventions.hpp"
#include "posewright/calibration/fit.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Throws CannotDo with the poses whose readings no robot gives while the others fit: an estimate would go astray.
/// Robust weights leave them aside.
/// @param notes  on the file, said with it
void refuse_gross_poses(const IdentificationModel& model, const VariantColumns& columns,
                        const std::vector<MeasuredPose>& poses, const std::vector<double>& placed, FitOptions options,
                        const std::vector<std::string>& notes);

/// Throws CannotDo with the convention that the file does not keep: parameters would bend the robot to it.
void refuse_conventions(const Problem& problem, const IdentificationModel& model, const VariantColumns& columns,
                        const std::vector<MeasuredPose>& poses, const std::vector<double>& placed,
                        const OrientationForm& orientation);

}  // namespace posewright
