#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// One row a planner: the name users write and what it does.
struct PlannerEntry {
  std::string name;
  std::string summary;
  std::unique_ptr<Planner> (*make)();
};

const std::vector<PlannerEntry>& planner_registry();
/// nullptr if no planner has that name.
std::unique_ptr<Planner> make_planner(const std::string& name);
/// "exchange, …": for messages with the allowed values.
std::string planner_names();

}  // namespace posewright
