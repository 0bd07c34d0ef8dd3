#pragma once

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Covariance (m²) of one reading of a point at p in the station's frame. A tracker's is an ellipsoid with one axis
/// along p: σ∥ = range + range_per_m·‖p‖, σ⊥ = transverse + angle·‖p‖ (theory.md eq. (10)).
Eigen::Matrix3d point_covariance(const PointNoise& noise, const Eigen::Vector3d& p_Station);
/// Derivative of ⟨slope, point_covariance⟩ by the point; slope symmetric.
Eigen::Vector3d point_covariance_change(const PointNoise& noise, const Eigen::Vector3d& p_Station,
                                        const Eigen::Matrix3d& slope);

}  // namespace posewright
