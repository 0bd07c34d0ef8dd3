#include "checks.hpp"

namespace posewright {

Checks range_checks(const CheckContext& context) {
  Checks checks;
  add_limits_check(context, checks);
  add_coupled_checks(context, checks);
  add_actuator_checks(context, checks);
  return checks;
}

/// A new constraint is one row here.
Checks pose_checks(const CheckContext& context) {
  Checks checks = range_checks(context);
  add_approach_check(context, checks);
  add_measurable_check(context, checks);
  add_tool_check(context, checks);
  add_singularity_check(context, checks);
  add_direction_check(context, checks);
  add_collision_check(context, checks);
  add_sight_check(context, checks);
  add_reachable_check(context, checks);
  return checks;
}

}  // namespace posewright
