#pragma once

#include "posewright/planning/design_task.hpp"

namespace posewright {

// One row a planner.
Planner automatic_planner();
Planner exchange_planner();
Planner tabu_planner();
Planner greedy_planner();
Planner continuous_planner();
Planner branch_and_bound_planner();

}  // namespace posewright
