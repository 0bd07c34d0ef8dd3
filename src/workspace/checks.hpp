#pragma once

#include <memory>
#include <span>
#include <vector>

#include "posewright/cell/cell.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/workspace/validity_check.hpp"

namespace posewright {

using Checks = std::vector<std::unique_ptr<ValidityCheck>>;

/// Input of a constraint. All must outlive the checks.
struct CheckContext {
  const IdentificationModel& model;
  const Problem& problem;
  const std::vector<Coordinate>& coordinates;  ///< with the limits in force
  const Cell* cell;                            ///< null: no bodies, no sights
  const Monitor* monitor = nullptr;            ///< of checks that take long to make; null: none watches
  /// ξ − nominal of robots that the instrument must be able to read, too.
  std::span<const std::vector<double>> robots{};
};

/// Checks for motions between poses but those of bodies: limits, coupled limits, reach and travel of actuators.
Checks range_checks(const CheckContext& context);
/// All constraints on a measurement, in the order of cost.
Checks pose_checks(const CheckContext& context);

// One maker a constraint; if the problem does not ask for it, nothing is added.
void add_limits_check(const CheckContext& context, Checks& checks);
void add_coupled_checks(const CheckContext& context, Checks& checks);
void add_actuator_checks(const CheckContext& context, Checks& checks);
void add_approach_check(const CheckContext& context, Checks& checks);
void add_measurable_check(const CheckContext& context, Checks& checks);
void add_tool_check(const CheckContext& context, Checks& checks);
void add_singularity_check(const CheckContext& context, Checks& checks);
/// Parts of line of sight without bodies: most hidden targets face away, and collisions take a hundred times as long.
void add_direction_check(const CheckContext& context, Checks& checks);
void add_collision_check(const CheckContext& context, Checks& checks);
void add_sight_check(const CheckContext& context, Checks& checks);
void add_reachable_check(const CheckContext& context, Checks& checks);

}  // namespace posewright
