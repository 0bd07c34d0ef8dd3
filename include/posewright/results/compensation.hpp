#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/problem/problem.hpp"
#include "posewright/tasks/compensate_problem.hpp"

namespace posewright {

/// What a person reads: how many poses, how far the calibrated robot would miss them before and after, how far each
/// joint or actuator moves for it, which poses cannot be had and why.
std::string compensation_text(const Compensation& compensation);

/// The same with every pose, for machines: schema posewright/compensation/1.
/// @param problem  with the parameters
nlohmann::ordered_json compensation_json(const Problem& problem, const Compensation& compensation);

}  // namespace posewright
