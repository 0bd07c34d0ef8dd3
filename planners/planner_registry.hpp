#pragma once

#include <string>
#include <vector>

#include "posewright/planning/design_task.hpp"

namespace posewright {

const std::vector<Planner>& planner_registry();
/// nullptr if no planner has that name.
const Planner* find_planner(const std::string& name);
/// "exchange, …": for messages with the allowed values.
std::string planner_names();

}  // namespace posewright
