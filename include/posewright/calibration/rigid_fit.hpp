#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace posewright {

/// Pose of a rigid body from points on it.
struct RigidFit {
  Eigen::Isometry3d X;  ///< measured = X · body
  Eigen::Matrix<double, 6, 6>
      covariance;    ///< of the spatial twist about the body's origin, for points of unit variance
  double rms = 0.0;  ///< of the distances that are left, m
};

/// Least-squares fit without scale (orthogonal Procrustes: Arun, Huang & Blostein 1987; Umeyama 1991).
/// Throws CannotDo for fewer than three points or points in a line.
RigidFit rigid_fit(const std::vector<Eigen::Vector3d>& body, const std::vector<Eigen::Vector3d>& measured);

}  // namespace posewright
