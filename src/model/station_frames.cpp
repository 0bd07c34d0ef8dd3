#include "station_frames.hpp"

#include <numbers>

#include "posewright/model/placement.hpp"

namespace posewright {
namespace {

// An instrument is put down by eye: what is known of its place before the fit.
constexpr double station_length_tolerance = 10e-3, station_angle_tolerance = std::numbers::pi / 180;  // m, rad

const double* station_part(std::span<const double> correction, int station) {
  return correction.empty() ? nullptr : correction.data() + 6 * station;
}

}  // namespace

Stations::Stations(const std::vector<StationSpec>& specs) {
  for (const StationSpec& spec : specs) {
    X_MeasureStation_.push_back(isometry(spec.placement));
    names_.push_back(spec.name);
  }
}

void Stations::append(std::vector<Parameter>& parameters) const {
  for (std::size_t i = 0; i < names_.size(); ++i)
    append_displacement(parameters, "station." + names_[i], X_MeasureStation_[i], station_length_tolerance,
                        station_angle_tolerance);
}

Eigen::Isometry3d Stations::pose(int station, std::span<const double> correction) const {
  if (empty()) return Eigen::Isometry3d::Identity();
  if (correction.empty()) return X_MeasureStation_[std::size_t(station)];
  Frame<double> frame = frame_of(X_MeasureStation_[std::size_t(station)]);
  displace(frame, station_part(correction, station));
  return isometry_of(frame);
}

Twist Stations::apparent_motion(int station, std::span<const double> correction, int index) const {
  if (index / 6 != station) return Twist::Zero();
  Frame<double> frame = frame_of(X_MeasureStation_[std::size_t(station)]);
  return -displace(frame, station_part(correction, station)).twist(index % 6);
}

}  // namespace posewright
