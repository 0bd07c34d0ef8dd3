#pragma once

#include <memory>

#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// The instrument of a problem file.
std::unique_ptr<MeasurementModel> make_measurement(const MeasurementSpec& spec);

}  // namespace posewright
