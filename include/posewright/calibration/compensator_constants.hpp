#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/problem/robot_specs.hpp"

namespace posewright {

/// Compliances of a compensated joint, each identified where the joint stands at one position.
struct ListedCompliances {
  std::vector<double> at;      ///< rad
  Eigen::VectorXd compliance;  ///< rad/(N·m), size at
  Eigen::MatrixXd covariance;  ///< of them
};

/// Spring and joint stiffness of a gravity compensator, from the joint's compliances.
struct CompensatorConstants {
  double joint_stiffness = 0.0;  ///< K2⁰, N·m/rad
  double stiffness = 0.0;        ///< Kc, N/m
  double preload = 0.0;          ///< s0·Kc, N
  double free_length = 0.0;      ///< s0, m
  Eigen::Matrix3d covariance;    ///< of K2⁰, Kc, s0·Kc
  double free_length_sigma = 0.0;
  double chi_square = 0.0;  ///< of the compliances' residuals
  int freedom = 0;          ///< compliances − 3
};

/// Klimchik et al. (2013), eq. (13) and (14) with s² under aL in the last term, weighted by the covariance of the
/// compliances (to first order in 1/k). Geometry (L, ax, ay) counts as known.
/// Throws CannotDo for fewer than three compliances, for one that is not positive, for positions that do not tell the
/// three constants apart, and for a covariance that is not positive definite.
CompensatorConstants compensator_from_compliances(const CompensatorSpec& geometry, const ListedCompliances& listed);

}  // namespace posewright
