#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/outputs/plan.hpp"

namespace posewright {

/// Dependence of a plan's accuracy on a complete model: SI, as in plan.json (docs/plan-file.md).
nlohmann::ordered_json reliance_json(const Reliance& reliance);

/// Text in a sentence, with a warning above an amplification of 1.5.
std::string reliance_text(const Reliance& reliance);

}  // namespace posewright
