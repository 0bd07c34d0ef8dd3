#include "planner_registry.hpp"

#include "planners.hpp"

namespace posewright {

const std::vector<Planner>& planner_registry() {
  static const std::vector<Planner> table = {automatic_planner(), exchange_planner(),   tabu_planner(),
                                             greedy_planner(),    continuous_planner(), branch_and_bound_planner()};
  return table;
}

const Planner* find_planner(const std::string& name) {
  for (const Planner& planner : planner_registry())
    if (planner.name == name) return &planner;
  return nullptr;
}

std::string planner_names() {
  std::string names;
  for (const Planner& planner : planner_registry()) names += (names.empty() ? "" : ", ") + planner.name;
  return names;
}

}  // namespace posewright
