#pragma once

#include "local_search.hpp"

namespace posewright {

/// Tabu search (Glover 1989, ORSA J. Computing 1(3)) over the swaps that `exchange` looks at: the best swap is taken
/// even if it loses; who left may not come back and who entered may not leave for a while (the tenure, drawn anew each
/// time), unless that gives the best design ever seen (aspiration). Ends after `idle` swaps without a new best. Starts
/// as `exchange`, each from its local optimum.
class TabuPlanner : public Planner {
 public:
  std::string name() const override { return "tabu"; }

 private:
  Design do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const override;
};

/// Swaps without a new best after which a start ends, where `exchange` would have made so many kicks.
int tabu_patience(const DesignTask& task, const PlannerOptions& options);

/// Overload from a given design.
Outcome tabu_search(const DesignTask& task, std::vector<int> start, int idle, Random& random, const Monitor& monitor);

}  // namespace posewright
