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

}  // namespace posewright
