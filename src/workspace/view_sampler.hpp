#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "posewright/cell/line_of_sight.hpp"
#include "posewright/support/random.hpp"

namespace posewright {

/// Configurations from which the instrument sees its targets: a pose of the tip that does, and the joints that reach
/// it, by damped least squares from where the draw began (Levenberg 1944), so that all branches of the inverse
/// kinematics and all of a redundant arm's are found. Const and callable from several threads.
class ViewSampler {
 public:
  /// @param coordinates  where configurations are proposed
  /// All must outlive the sampler.
  ViewSampler(const IdentificationModel& model, const LineOfSight& sight, const std::vector<Coordinate>& coordinates);

  /// Moves q to where the tip has a pose that sees. False if no configuration near q within the limits reaches it; q is
  /// then the nearest that was found, and may still see.
  bool move_to_view(std::span<double> q, Random& random) const;

 private:
  using Error = Eigen::Matrix<double, 6, 1>;
  /// ∂ error of X = the tip's pose at q by each moving coordinate; `trial` is scratch.
  void fill_jacobian(std::span<const double> q, const Eigen::Isometry3d& X, const Eigen::Isometry3d& wanted,
                     const Error& error, std::vector<double>& trial, Eigen::Matrix<double, 6, Eigen::Dynamic>& J) const;

  const IdentificationModel& model_;
  const LineOfSight& sight_;
  const std::vector<Coordinate>& coordinates_;
  std::vector<std::size_t> moving_;
};

}  // namespace posewright
