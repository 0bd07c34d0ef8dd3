#pragma once

#include <string>
#include <vector>

#include "posewright/outputs/plan.hpp"
#include "posewright/outputs/written_with.hpp"

namespace posewright {

/// plan.json, schema posewright/plan/1 (docs/plan-file.md): SI units, shortest decimals that read back bit-equal.
/// @param files  that are written with it
std::string plan_json(const Plan& plan, const std::vector<WrittenWith>& files = {});

/// One line for each pose that is still to be measured: id, configuration, actuators; header `name [unit]`. Empty for a
/// plan without configurations.
std::string poses_csv(const Plan& plan);

/// The table a person reads: certificate, parameters with σ against tolerance (mm, deg), where candidates were lost.
std::string plan_summary(const Plan& plan);

}  // namespace posewright
