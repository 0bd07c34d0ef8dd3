#include "posewright/lists/platform_images.hpp"

#include "posewright/model/instrument_view.hpp"

namespace posewright {

std::optional<PlatformPoints> platform_points(const RobotSpec& robot, const MeasurementSpec& measurement,
                                              const IdentificationModel& model) {
  if (std::get_if<SixLegsSpec>(&robot) == nullptr) return std::nullopt;
  const InstrumentView view = view_of(measurement);
  if (!view.point_noise) return std::nullopt;  // another at every distance: no single shape's
  PlatformPoints points{view.targets, *view.point_noise, {}};
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
