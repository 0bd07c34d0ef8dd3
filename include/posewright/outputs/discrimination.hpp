#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/outputs/plan.hpp"

namespace posewright {

/// What a plan and a comparison write of the test (docs/plan-file.md).
nlohmann::ordered_json discrimination_json(const Discrimination& test);
/// The same in words, a few lines.
/// @param fitted  variant
std::string discrimination_text(const Discrimination& test, const std::string& fitted);

}  // namespace posewright
