#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/outputs/plan.hpp"

namespace posewright {

/// Error to expect: SI, as in plan.json (docs/plan-file.md).
nlohmann::ordered_json expected_error_json(const ExpectedError& expected);

/// "0.041 mm (0.021 to 0.098 mm)": with the usual effect, and the range over robots.
std::string with_effect_text(const ExpectedError& expected);

/// Text in two lines, with a warning above an amplification of 1.5.
std::string expected_error_text(const ExpectedError& expected);

/// "20 test poses, with the best base and tool".
std::string places_text(const ExpectedError& expected);

}  // namespace posewright
