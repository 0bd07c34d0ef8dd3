#pragma once

#include <memory>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/workspace/validity_check.hpp"

namespace posewright {

/// Checks of a parallel robot: a solution of the inverse kinematics exists; every actuator stays within its travel.
/// None for robots without actuators of that kind.
std::vector<std::unique_ptr<ValidityCheck>> actuator_checks(const IdentificationModel& model);

}  // namespace posewright
