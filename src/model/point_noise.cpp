#include "point_noise.hpp"

namespace posewright {
namespace {

struct CovarianceAt {
  const Eigen::Vector3d& p;

  Eigen::Matrix3d operator()(const GaussianNoise& noise) const { return noise.covariance; }
  Eigen::Matrix3d operator()(const TrackerNoise& noise) const {
    const double distance = p.norm();
    const double along = noise.range + noise.range_per_m * distance, across = noise.transverse + noise.angle * distance;
    const Eigen::Vector3d beam = distance > 0 ? Eigen::Vector3d(p / distance) : Eigen::Vector3d::UnitX();
    return across * across * Eigen::Matrix3d::Identity() + (along * along - across * across) * beam * beam.transpose();
  }
};

}  // namespace

Eigen::Matrix3d point_covariance(const PointNoise& noise, const Eigen::Vector3d& p_Station) {
  return std::visit(CovarianceAt{p_Station}, noise);
}

Eigen::Vector3d point_covariance_change(const PointNoise& noise, const Eigen::Vector3d& p_Station,
                                        const Eigen::Matrix3d& slope) {
  const auto* tracker = std::get_if<TrackerNoise>(&noise);
  const double distance = p_Station.norm();
  if (tracker == nullptr || !(distance > 0)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d beam = p_Station / distance, along_slope = slope * beam;
  const double along = tracker->range + tracker->range_per_m * distance,
               across = tracker->transverse + tracker->angle * distance;
  // σ⊥² tr A + (σ∥² − σ⊥²) bᵀ A b, b = p/‖p‖.
  const double by_across = 2 * across * tracker->angle, in_beam = beam.dot(along_slope);
  const double by_distance = by_across * slope.trace() + (2 * along * tracker->range_per_m - by_across) * in_beam;
  return by_distance * beam + 2 * (along * along - across * across) / distance * (along_slope - in_beam * beam);
}

}  // namespace posewright
