#pragma once

#include <optional>

#include "posewright/study/expected_error.hpp"
#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// The problem at the values that a calibration found.
Problem at_estimate(Problem problem, const std::string& variant, const std::vector<EstimatedValue>& values,
                    const std::filesystem::path& data);

/// Of the readings that were fitted.
FittedResiduals fitted_residuals(const Fit& fit);

/// Error to expect at the test poses, without any at 200 feasible poses within the measured ranges of the coordinates
/// (throughout the workspace where fewer than 50 of 10,000 drawn there are feasible), with an effect as large as the
/// residuals show, or as the fit counts. None for fits that are not weighted by the noise or leave no residual.
/// @param columns  that were estimated
/// @param poses    that were fitted
std::optional<ExpectedError> calibrated_error(const ProblemVariant& fitted, const VariantColumns& columns,
                                              const std::vector<MeasuredPose>& poses, const Calibration& found,
                                              const Monitor& monitor);

}  // namespace posewright
