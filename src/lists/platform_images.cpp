#include "posewright/lists/platform_images.hpp"

#include <cmath>

namespace posewright {

std::optional<PlatformPoints> platform_points(const Problem& problem, const IdentificationModel& model) {
  if (std::get_if<SixLegsSpec>(&problem.robot) == nullptr) return std::nullopt;
  PlatformPoints points;
  if (const auto* pose = std::get_if<PoseMeasurement>(&problem.measurement.instrument)) {
    points.body = pose->photogrammetry;
    points.noise = pose->point_sigma;
  } else if (const auto* targets = std::get_if<PointsMeasurement>(&problem.measurement.instrument)) {
    if (targets->components.size() < 3) return std::nullopt;
    points.body = targets->targets;
    const auto* noise = std::get_if<GaussianNoise>(&targets->noise);
    if (noise == nullptr) return std::nullopt;  // another at every distance: no single shape's
    points.noise = std::sqrt(noise->covariance.trace() / 3);
  }
  if (points.body.size() < 3) return std::nullopt;
  for (const Coordinate& actuator : model.actuators())
    points.joints.push_back(actuator.name.substr(0, actuator.name.rfind('.')));
  return points;
}

Eigen::VectorXd actuator_moves(const IdentificationModel& model, const std::vector<double>& q) {
  const auto legs = model.actuators().size();
  std::vector<double> at(legs), reference(legs);
  const std::vector<double> zero(model.coordinates().size(), 0.0);
  if (!model.actuator_values(q, at) || !model.actuator_values(zero, reference)) return {};
  return Eigen::Map<const Eigen::VectorXd>(at.data(), Eigen::Index(legs)) -
         Eigen::Map<const Eigen::VectorXd>(reference.data(), Eigen::Index(legs));
}

}  // namespace posewright
