#pragma once

#include <optional>
#include <span>
#include <vector>

#include "posewright/results/plan.hpp"
#include "posewright/study/study.hpp"

/// One configuration as plan.json states it.
namespace posewright {

/// Configuration, actuators, labels and tool pose of q.
PlannedPose pose_of(const IdentificationModel& model, std::span<const double> q);

/// Every target of q as its station sees it; none where the instrument that reads has no place.
std::vector<TargetSight> sights_of(const Cell& cell, std::span<const double> q);
TargetSight target_sight(const LineOfSight& sight, const Sight& s, int station);

/// As it is written.
std::optional<BodyDistance> body_distance(const std::optional<Separation>& found);
/// Nearest pair of bodies at q; none without collision checks.
std::optional<BodyDistance> nearest_at(const Cell& cell, std::span<const double> q);

}  // namespace posewright
