#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace posewright {

/// One image of a platform: points that belong to the rigid body, and the joint centres on it. m, measurement frame.
struct PlatformImage {
  int id = 0;  ///< of the pose
  std::vector<Eigen::Vector3d> body, joints;
  Eigen::VectorXd actuators;  ///< how far each stands from the reference (Δρ), one per joint centre
};

/// Motion of one joint centre on its platform, along the platform's z axis: Δb = κ Δρ of its own leg, and
/// Δb = Σ_j K_j Δρ_j. Ordinary least squares with an intercept (the centre's mean place).
struct JointDeformation {
  double largest = 0.0;                         ///< of the displacement in z from the mean place, m
  Eigen::Vector3d spread;                       ///< standard deviation of x, y, z on the platform, m
  double kappa = 0.0, kappa_sigma = 0.0;        ///< dimensionless
  Eigen::RowVectorXd K, K_sigma;                ///< one row of the matrix
  double left_by_kappa = 0.0, left_by_K = 0.0;  ///< root mean square of z that each leaves, m
};

/// Is the platform rigid, and how do its joint centres move? Telescope study, section IV: eq. (7) to (9).
struct PlatformDeformation {
  int images = 0;
  double chi_square = 0.0;  ///< of the body's points about a common rigid shape, in units of the stated noise
  int freedom = 0;          ///< 0: too few points to tell
  double rms = 0.0;         ///< of their distances from that shape, m
  std::vector<JointDeformation> joints;
  std::vector<int> ids;                         ///< per image
  std::vector<Eigen::VectorXd> actuators;       ///< per image: Δρ, m
  std::vector<Eigen::Matrix3Xd> displacements;  ///< per image: Δb of every joint centre, platform frame, m
};

/// The body's pose is its rigid fit (rigid_fit()) to a shape that is estimated from all images together (generalised
/// Procrustes, started at `nominal`), so that nobody needs to know where its points are.
/// @param nominal  places of the body's points in the platform's frame: they say where z is
/// @param noise    1σ of one coordinate of a point, m
/// Throws CannotDo for fewer than three points, points in a line, and fewer images than a row of K has unknowns.
PlatformDeformation platform_deformation(const std::vector<Eigen::Vector3d>& nominal,
                                         const std::vector<PlatformImage>& images, double noise);

}  // namespace posewright
