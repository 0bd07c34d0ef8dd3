#include "displacement.hpp"

#include <cmath>
#include <limits>

namespace posewright {

Frame<double> frame_of(const Eigen::Isometry3d& X) {
  Frame<double> frame;
  frame.R = X.linear();
  frame.p = X.translation();
  return frame;
}

Eigen::Isometry3d isometry_of(const Frame<double>& frame) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = frame.R;
  X.translation() = frame.p;
  return X;
}

void change_frame(const Eigen::Isometry3d& X_AB, Eigen::Ref<Twists> twists) {
  for (Eigen::Index j = 0; j < twists.cols(); ++j) {
    const Eigen::Vector3d w = X_AB.linear() * twists.col(j).tail<3>();
    twists.col(j).head<3>() = X_AB.linear() * twists.col(j).head<3>() + X_AB.translation().cross(w);
    twists.col(j).tail<3>() = w;
  }
}

Coordinate pose_coordinate(const std::string& name, std::size_t k, double reach,
                           const std::vector<CoordinateLimits>& limits) {
  Coordinate coordinate{name, k < 3 ? "m" : "rad", -reach, reach};
  for (const CoordinateLimits& own : limits)
    if (own.name.value == name) {
      coordinate.lower = own.lower;
      coordinate.upper = own.upper;
    }
  return coordinate;
}

void append_displacement(std::vector<Parameter>& parameters, const std::string& name, const Eigen::Isometry3d& X,
                         double length_tolerance, double angle_tolerance) {
  Eigen::Vector3d nominal = X.linear().transpose() * X.translation();
  // What turning by right angles leaves of zero is zero: tables show it.
  for (double& value : nominal)
    if (std::abs(value) < 4 * std::numeric_limits<double>::epsilon() * X.translation().norm()) value = 0;
  for (int k = 0; k < 6; ++k)
    parameters.push_back({name + "." + displacement_names[std::size_t(k)], k < 3 ? "m" : "rad",
                          k < 3 ? nominal[k] : 0.0, k < 3 ? length_tolerance : angle_tolerance, Role::interest});
}

std::span<const double> without_block(std::span<const double> correction, int first, std::size_t count,
                                      std::vector<double>& rest) {
  rest.clear();
  if (correction.empty()) return {};
  const auto block = correction.begin() + first;
  rest.assign(correction.begin(), block);
  rest.insert(rest.end(), block + std::ptrdiff_t(count), correction.end());
  return rest;
}

}  // namespace posewright
