#pragma once

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// `auto`: greedy → exchange → tabu → poses moved between the candidates → configurations of large d(q) as new
/// candidates, exchanged and moved again. Each stage starts from the best so far and never loses it; Design::stages
/// tells what each gained. Under a time limit each stage has a share of what is left, and rounds with other seeds
/// follow until the time is used. Without a space the last two stages fall away.
class AutomaticPlanner : public Planner {
 public:
  std::string name() const override { return "auto"; }

 private:
  Design do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const override;
};

}  // namespace posewright
