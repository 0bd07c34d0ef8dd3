#pragma once

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// Adds the best candidate until there are N. The first start begins with nothing; the others with one random
/// candidate, because the first choices, made while most parameters are unknown, decide much (GRASP, Feo & Resende
/// 1995). No exchange follows: what greedy misses is what the other planners add.
class GreedyPlanner : public Planner {
 public:
  std::string name() const override { return "greedy"; }

 private:
  Design do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const override;
};

}  // namespace posewright
