#pragma once

#include <nlohmann/json.hpp>

#include "posewright/outputs/plan.hpp"

namespace posewright {

nlohmann::ordered_json sight_json(const TargetSight& sight);

}  // namespace posewright
