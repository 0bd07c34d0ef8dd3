#include "posewright/tasks/planned_pose.hpp"

namespace posewright {
namespace {

std::vector<NamedValue> named(const std::vector<Coordinate>& coordinates, std::span<const double> values) {
  std::vector<NamedValue> result;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (!coordinates[i].choice()) result.push_back({coordinates[i].name, coordinates[i].unit, values[i]});
  return result;
}

}  // namespace

PlannedPose pose_of(const IdentificationModel& model, std::span<const double> q) {
  PlannedPose pose;
  pose.configuration = named(model.coordinates(), q);
  pose.choices = choices_at(model.coordinates(), q);
  std::vector<double> actuators(model.actuators().size());
  if (model.actuator_values(q, actuators)) pose.actuators = named(model.actuators(), actuators);
  pose.tool_pose = model.tool_pose(q);
  return pose;
}

std::vector<TargetSight> sights_of(const Cell& cell, std::span<const double> q) {
  std::vector<TargetSight> result;
  for (const LineOfSight* sight : cell.sights_at(q)) {
    const auto [first, last] = sight->stations_of(q);
    for (int station = first; station <= last; ++station)
      for (const Sight& s : sight->sights(q, station)) result.push_back(target_sight(*sight, s, station));
  }
  return result;
}

TargetSight target_sight(const LineOfSight& sight, const Sight& s, int station) {
  TargetSight result;
  result.target = s.target;
  result.station = sight.stations()[std::size_t(station)];
  result.position = s.p_StationTarget;
  result.distance = s.distance;
  result.azimuth = s.azimuth;
  result.elevation = s.elevation;
  result.incidence = s.incidence;
  result.judged = sight.judges();
  if (s.hidden_by >= 0) result.hidden_by = sight.reasons()[std::size_t(s.hidden_by)];
  return result;
}

std::optional<BodyDistance> body_distance(const std::optional<Separation>& found) {
  if (!found) return std::nullopt;
  return BodyDistance{found->distance, found->first, found->second, found->points};
}

std::optional<BodyDistance> nearest_at(const Cell& cell, std::span<const double> q) {
  return cell.collision == nullptr ? std::nullopt : body_distance(cell.collision->nearest(q));
}

}  // namespace posewright
