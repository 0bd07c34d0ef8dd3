#pragma once

#include "calibration_accuracy.hpp"

namespace posewright {

/// Says whether the estimate is to be used: fills verdict and refusals, adds a note where no gain is shown.
void judge_calibration(const CalibratedPoses& poses, Calibration& result);

}  // namespace posewright
