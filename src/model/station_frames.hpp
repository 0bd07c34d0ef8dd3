#pragma once

#include "displacement.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Places an instrument stands at, each with parameters station.NAME.{x,…,rz} (displacement of its frame).
class Stations {
 public:
  explicit Stations(const std::vector<StationSpec>& specs);

  bool empty() const { return X_MeasureStation_.empty(); }
  int parameter_count() const { return 6 * int(X_MeasureStation_.size()); }
  void append(std::vector<Parameter>& parameters) const;
  const std::vector<std::string>& names() const { return names_; }

  /// Pose of a station with the corrections (of all stations, or empty); identity if there are no stations.
  Eigen::Isometry3d pose(int station, std::span<const double> correction) const;
  /// Twist of the tip that looks the same as moving along station parameter `index`: zero for the others' parameters.
  Twist apparent_motion(int station, std::span<const double> correction, int index) const;

 private:
  std::vector<Eigen::Isometry3d> X_MeasureStation_;
  std::vector<std::string> names_;
};

}  // namespace posewright
