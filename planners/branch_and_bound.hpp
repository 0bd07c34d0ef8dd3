#pragma once

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// The proved optimum over the candidates, for small tasks (Welch 1982, Technometrics 24(1); Ahipaşaoğlu 2021). Each
/// node fixes how often some candidates are chosen at least and at most; its bound is the approximate optimum of the
/// rest with what is fixed as prior. Sensitivities also fix candidates that cannot be in, or cannot be missing from,
/// anything better than the best design known, which `exchange` finds first. Criteria without a bound are enumerated;
/// throws CannotDo if that would be more than a few million sets. Ends early when the monitor says so; `optimal`
/// tells.
class BranchAndBoundPlanner : public Planner {
 public:
  std::string name() const override { return "branch_and_bound"; }

 private:
  Design do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const override;
};

}  // namespace posewright
