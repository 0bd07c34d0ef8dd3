#pragma once

#include <Eigen/Core>
#include <vector>

namespace posewright {

/// The value in the middle, the upper one of two; there is one at least.
double median(std::vector<double> values);

enum class RobustShape { huber, tukey };

/// Weight of every group (a target's whitened residual) from its squared norm: 1 for what is ordinary, less or 0 for
/// what lies far off, in units of the central part of all groups.
/// @param squares  ‖r‖² of every group
/// @param sizes    how many rows each has; the norms are compared as standard normal quantiles, so that groups of
///                 different size mix
Eigen::VectorXd robust_weights(const Eigen::VectorXd& squares, const Eigen::VectorXd& sizes, RobustShape shape);

/// Size of the noise as its central part tells.
struct RobustScale {
  double central = 0.0;          ///< 1: as stated
  double variance_factor = 0.0;  ///< times (JᵀJ)⁻¹: covariance of the estimates (Huber 1981, eq. 7.6.6), Tukey's ψ
};
/// @param parameters  how many were estimated from these rows
RobustScale robust_scale(const Eigen::VectorXd& squares, const Eigen::VectorXd& sizes, int parameters);

}  // namespace posewright
