#pragma once

#include <optional>
#include <vector>

#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Points of a platform that are read beside its pose: those that make the rigid body, and columns `leg_i.x`,
/// `leg_i.y`, `leg_i.z` of the joint centres.
struct PlatformPoints {
  std::vector<TargetSpec> body;
  double noise = 0.0;               ///< 1σ of a coordinate, m
  std::vector<std::string> joints;  ///< "leg_1", …
};

/// Empty for robots without six legs and instruments without points of the platform.
std::optional<PlatformPoints> platform_points(const RobotSpec& robot, const MeasurementSpec& measurement,
                                              const IdentificationModel& model);

/// Actuator positions less those of the nominal robot at the reference. Empty if q is out of reach.
Eigen::VectorXd actuator_moves(const IdentificationModel& model, const std::vector<double>& q);

}  // namespace posewright
