#include <iostream>

#include "planners/planner_registry.hpp"
#include "posewright/criterion/observability_indices.hpp"
#include "posewright/tasks/plan_problem.hpp"

int main() {
  std::cout << posewright::observability_indices(Eigen::Vector3d(4, 2, 1), 3).o2 << " " << posewright::planner_names()
            << "\n";
  return posewright::find_planner("exchange") == nullptr;
}
