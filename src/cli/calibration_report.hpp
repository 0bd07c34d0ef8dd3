#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/pipeline/calibrate_problem.hpp"

namespace posewright::cli {

/// What a person reads: parameters with intervals, residuals before and after, what the residuals say of the model.
std::string calibration_text(const Calibration& calibration);

/// The same for machines, nothing left out: what posewright/calibration/1 has besides program and problem.
nlohmann::ordered_json calibration_json(const Calibration& calibration);

}  // namespace posewright::cli
