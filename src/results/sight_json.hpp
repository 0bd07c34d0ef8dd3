#pragma once

#include <nlohmann/json.hpp>

#include "posewright/results/plan.hpp"

namespace posewright {

nlohmann::ordered_json sight_json(const TargetSight& sight);
/// Actuators of a parallel robot, by name.
nlohmann::ordered_json actuators_json(const PlannedPose& pose);
/// null if there is none
nlohmann::ordered_json nearest_json(const std::optional<BodyDistance>& nearest);
nlohmann::ordered_json tool_pose_json(const Eigen::Isometry3d& X);
/// Key `problem` of plans and routes.
nlohmann::ordered_json problem_json(const ProblemOrigin& problem);
/// Key `files` of plans and routes.
nlohmann::ordered_json files_json(const std::vector<WrittenWith>& files);
nlohmann::ordered_json curve_point_json(const CurvePoint& point);
/// An entry of `poses` of plans.
nlohmann::ordered_json planned_pose_json(const PlannedPose& pose);

}  // namespace posewright
