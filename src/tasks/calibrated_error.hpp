#pragma once

#include <optional>

#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// The problem at the values that a calibration found.
Problem at_estimate(Problem problem, const std::string& variant, const std::vector<EstimatedValue>& values,
                    const std::filesystem::path& data);

/// Error to expect at the test poses, without any at 200 poses throughout the workspace, with an effect as large as the
/// residuals show, or as the fit counts. None for fits that are not weighted by the noise or leave no residual.
/// @param columns  that were estimated
/// @param poses    that were fitted
std::optional<ExpectedError> calibrated_error(const ProblemVariant& fitted, const VariantColumns& columns,
                                              const std::vector<MeasuredPose>& poses, const Calibration& found,
                                              const Monitor& monitor);

}  // namespace posewright
