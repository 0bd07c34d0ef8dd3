#pragma once

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// `auto`, where poses can be moved: greedy → exchange from a dozen starts (the greedy set and optimal weights, among
/// the candidates and with the configurations that the weights use over the workspace) → the best of each moved between
/// the candidates for a few rounds, the best of all to the end → all places found so far as candidates, exchanged and
/// moved again while a round gains. For blocks alone: greedy → exchange with all restarts → tabu. Each stage starts
/// from the best so far and never loses it; Design::stages tells what each gained. Under a time limit rounds of
/// exchange with restarts and kicks, tabu and moves follow with other seeds until the time is used.
class AutomaticPlanner : public Planner {
 public:
  std::string name() const override { return "auto"; }

 private:
  Design do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const override;
};

}  // namespace posewright
