#pragma once

#include <string>

#include "posewright/outputs/plan.hpp"

namespace posewright {

/// plan.json, schema posewright/plan/1 (docs/plan-file.md): SI units, shortest decimals that read back bit-equal.
std::string plan_json(const Plan& plan);

/// One line for each pose that is still to be measured: id, configuration, actuators; header `name [unit]`. Empty for a
/// plan without configurations.
std::string poses_csv(const Plan& plan);

/// The table a person reads: certificate, parameters with σ against tolerance (mm, deg), where candidates were lost.
std::string plan_summary(const Plan& plan);

}  // namespace posewright
