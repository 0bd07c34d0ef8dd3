#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/outputs/plan.hpp"

namespace posewright {

/// How much a plan's accuracy relies on the model being complete: SI, as in plan.json (docs/plan-file.md).
nlohmann::ordered_json reliance_json(const Reliance& reliance);

/// The same in a sentence, and another one where the estimate makes half as much again of an effect.
std::string reliance_text(const Reliance& reliance);

}  // namespace posewright
