#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/results/plan.hpp"

namespace posewright {

/// Error to expect: SI, as in plan.json (docs/plan-file.md).
nlohmann::ordered_json expected_error_json(const ExpectedError& expected);

/// "with the effects that robots have".
std::string origin_text(const ExpectedError& expected);

/// "0.041 mm (0.021 to 0.098 mm)": with the usual effect, and the range over robots.
std::string with_effect_text(const ExpectedError& expected);

/// "0.041 mm (0.021 to 0.098 mm) with the effects that robots have, 0.019 mm from noise alone".
std::string error_text(const ExpectedError& expected);

/// "Root mean square at 20 test poses. Robots have effects …", a line, and a warning above an amplification of 1.5.
std::string error_circumstances(const ExpectedError& expected);

/// What is predicted, then error_circumstances().
std::string expected_error_text(const ExpectedError& expected);

/// "20 test poses, with the best base and tool".
std::string places_text(const ExpectedError& expected);

}  // namespace posewright
