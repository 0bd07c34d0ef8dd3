#pragma once

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// The proved optimum over the candidates (Welch 1982, Technometrics 24(1)). Each node fixes how often some candidates
/// are chosen at least and at most (DesignTree); its bound is the optimum over numbers that need not be whole
/// (NodeRelaxation), which knows how few rows are left to choose (RankLimitedLogDet; RowInertia for o3). `exchange`
/// finds the design to begin with. Criteria without a bound are enumerated; throws CannotDo if that would be more than
/// a few million sets. Ends early when the monitor says so, or where PlannerOptions::gap lets it: `optimal` tells, and
/// `bound` what no design exceeds.
class BranchAndBoundPlanner : public Planner {
 public:
  std::string name() const override { return "branch_and_bound"; }

 private:
  Design do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const override;
};

}  // namespace posewright
