#pragma once

#include <memory>

#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// The instrument of a problem file that looks at a tip. Throws std::invalid_argument for one that does not (joint
/// sensors, distances between configurations).
std::unique_ptr<MeasurementModel> make_measurement(const MeasurementSpec& spec);

/// The robot as the problem's instrument sees it. Throws CannotDo if the robot lacks the measured quantity.
std::unique_ptr<IdentificationModel> observe(std::unique_ptr<TipModel> robot, const MeasurementSpec& measurement,
                                             const ProblemFile& file);

}  // namespace posewright
