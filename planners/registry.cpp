#include "registry.hpp"

#include "exchange.hpp"

namespace posewright {

const std::vector<PlannerEntry>& planner_registry() {
  static const std::vector<PlannerEntry> table = {
      {"exchange", "best exchange with rank-r updates from many starts",
       [] { return std::unique_ptr<Planner>(std::make_unique<ExchangePlanner>()); }},
  };
  return table;
}

std::unique_ptr<Planner> make_planner(const std::string& name) {
  for (const PlannerEntry& entry : planner_registry())
    if (entry.name == name) return entry.make();
  return nullptr;
}

std::string planner_names() {
  std::string names;
  for (const PlannerEntry& entry : planner_registry()) names += (names.empty() ? "" : ", ") + entry.name;
  return names;
}

}  // namespace posewright
