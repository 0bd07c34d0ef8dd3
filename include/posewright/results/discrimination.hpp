#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/results/plan.hpp"

namespace posewright {

/// JSON of the test in a plan and a comparison (docs/plan-file.md).
nlohmann::ordered_json discrimination_json(const Discrimination& test);
/// Text of the test, a few lines.
/// @param fitted  variant
std::string discrimination_text(const Discrimination& test, const std::string& fitted);

}  // namespace posewright
