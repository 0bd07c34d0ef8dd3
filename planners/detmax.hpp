#pragma once

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// Excursions (Mitchell 1974, Technometrics 16(2), DETMAX): from a design of N, k poses are added one by one, then as
/// many removed, or the other way about; where the way back ends better, the search goes on from there, else k grows.
/// Removals take the member that Φ misses least, additions the best candidate. Starts as `exchange`.
class DetmaxPlanner : public Planner {
 public:
  std::string name() const override { return "detmax"; }

 private:
  Design do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const override;
};

}  // namespace posewright
