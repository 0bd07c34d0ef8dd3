// What follows for the tip where a station sees enough targets (theory.md eq. (59)).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/cell/line_of_sight.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {

using Eigen::Vector3d;

/// Every target where all must be seen. Where k of n are enough, one of them is no farther from their mean than the
/// n − k + 1 nearest are.
void LineOfSight::take_necessary_places() {
  const int needed = spec_.visible == 0 ? targets() : spec_.visible;
  if (!judges_ || targets_.empty()) return;
  if (spec_.azimuth && spec_.azimuth->second - spec_.azimuth->first <= std::numbers::pi) {
    // Within a half circle an azimuth is between two sides: a · p ≥ 0 for both.
    const auto [from, to] = *spec_.azimuth;
    azimuth_sides_ = {{-std::sin(from), std::cos(from), 0.0}, {std::sin(to), -std::cos(to), 0.0}};
  }
  if (needed == targets()) {
    for (const Target& target : targets_) places_.push_back({target.position, target.normal});
    return;
  }
  Place mean;
  for (const Target& target : targets_) mean.position += target.position / double(targets_.size());
  std::vector<double> distances;
  for (const Target& target : targets_) distances.push_back((target.position - mean.position).norm());
  std::sort(distances.begin(), distances.end());
  mean.room = distances[std::size_t(targets() - needed)];
  mean.normal = targets_.front().normal;
  for (const Target& target : targets_)
    if (target.normal != mean.normal) mean.normal.reset();
  places_.push_back(mean);
}

/// In the order of necessary_values(): the squared distance, then one number for each limit of a direction. A target's
/// own numbers differ from the mean's by its distance at most, and so do roots of squares.
void LineOfSight::add_limits_of(const Place& place, NecessaryLimits& limits) const {
  const int square = limits.values++;
  const auto direction = [&](double factor, double root) {
    limits.of_points.push_back(
        {limits.values, factor, place.room * (1 + std::abs(root)), root == 0 ? -1 : square, root});
  };
  if (spec_.range) {
    const double near = spec_.range->first - place.room, far = spec_.range->second + place.room;
    if (near > 0) limits.of_points.push_back({square, 1.0, -near * near});
    if (std::isfinite(far)) limits.of_points.push_back({square, -1.0, far * far});
  }
  if (spec_.elevation) {
    direction(1.0, -std::sin(spec_.elevation->first));
    direction(-1.0, std::sin(spec_.elevation->second));
    ++limits.values;
  }
  for (std::size_t i = 0; i < azimuth_sides_.size(); ++i) {
    direction(1.0, 0.0);
    ++limits.values;
  }
  if (spec_.field_of_view) {
    direction(1.0, -std::cos(*spec_.field_of_view));
    ++limits.values;
  }
  if (spec_.acceptance && place.normal) {
    direction(1.0, -std::cos(*spec_.acceptance));
    ++limits.values;
  }
}

NecessaryLimits LineOfSight::necessary_limits() const {
  NecessaryLimits limits;
  const std::size_t stations = all_stations_ ? station_names_.size() : 1;
  for (std::size_t s = 0; s < stations; ++s)
    for (const Place& place : places_) add_limits_of(place, limits);
  if (!limits.of_points.empty()) limits.names = {"sight"};
  return limits;
}

void LineOfSight::necessary_values(std::span<const double> q, std::span<double> values) const {
  const Eigen::Isometry3d X_Tip = model_.tool_pose(q);
  const auto [first, last] = stations_of(q);
  std::size_t next = 0;
  for (int station = first; station <= last; ++station) {
    const Eigen::Isometry3d& X_Carrier = X_CarrierStation_[std::size_t(station)];
    const Eigen::Isometry3d X_Station = station_on_tip_ ? Eigen::Isometry3d(X_Tip * X_Carrier) : X_Carrier;
    for (const Place& place : places_) {
      const Vector3d p = targets_on_tip_ ? X_Tip * place.position : place.position;
      const Vector3d p_StationPlace = X_Station.inverse() * p;
      values[next++] = p_StationPlace.squaredNorm();
      if (spec_.elevation) values[next++] = p_StationPlace.z();
      for (const Vector3d& side : azimuth_sides_) values[next++] = side.dot(p_StationPlace);
      if (spec_.field_of_view) values[next++] = p_StationPlace.dot(*spec_.axis);
      if (!spec_.acceptance || !place.normal) continue;
      const Vector3d n = targets_on_tip_ ? Vector3d(X_Tip.linear() * *place.normal) : *place.normal;
      values[next++] = n.dot(X_Station.translation() - p);
    }
  }
}

}  // namespace posewright
