#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/problem/problem.hpp"
#include "posewright/tasks/compensate_problem.hpp"

namespace posewright {

/// Text for the terminal: number of poses, errors of the calibrated robot before and after, change of each
/// joint or actuator, poses that are not compensated, with reasons.
std::string compensation_text(const Compensation& compensation);

/// JSON with every pose: schema posewright/compensation/1.
/// @param problem  with the parameters
nlohmann::ordered_json compensation_json(const Problem& problem, const Compensation& compensation);

}  // namespace posewright
