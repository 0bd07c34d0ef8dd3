#include "planner_registry.hpp"

#include "automatic.hpp"
#include "branch_and_bound.hpp"
#include "continuous.hpp"
#include "exchange.hpp"
#include "greedy.hpp"
#include "tabu.hpp"

namespace posewright {
namespace {

template <class P>
PlannerEntry row(const char* summary) {
  return {P().name(), summary, [] { return std::unique_ptr<Planner>(std::make_unique<P>()); }};
}

}  // namespace

const std::vector<PlannerEntry>& planner_registry() {
  static const std::vector<PlannerEntry> table = {
      row<AutomaticPlanner>("greedy, exchange, tabu, continuous and new candidates in turn"),
      row<ExchangePlanner>("best exchange with rank-r updates from many starts"),
      row<TabuPlanner>("the same neighbourhood, going on where exchange stops"),
      row<GreedyPlanner>("one pose after the other, no way back"),
      row<ContinuousPlanner>("exchange, then the poses themselves are moved by NLopt"),
      row<BranchAndBoundPlanner>("the proved optimum of small problems"),
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
