#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "posewright/planning/design_task.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

Design Planner::plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const {
  if (task.candidates.blocks == nullptr || task.criterion == nullptr)
    throw std::invalid_argument("design task: blocks and criterion are required");
  const long available = long(task.candidates.blocks->count()) * task.candidates.max_repeats;
  if (task.poses < 1 || task.poses > available)
    throw std::invalid_argument("design task: " + std::to_string(task.poses) + " poses from " +
                                std::to_string(available) + " choices");
  if (options.restarts < 1) throw std::invalid_argument("planner options: restarts must be at least 1");
  Design design = do_plan(task, options, monitor);
  if (!std::isfinite(design.value))
    throw CannotDo("no set of " + std::to_string(task.poses) + " candidates was found that identifies all " +
                   std::to_string(task.candidates.blocks->columns()) +
                   " parameters: more poses, another method (exchange) or criterion (o1) may find one");
  std::sort(design.members.begin(), design.members.end());
  return design;
}

}  // namespace posewright
