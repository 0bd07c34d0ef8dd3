#include "measure_pose.hpp"

#include "measure_points.hpp"

namespace posewright {
namespace {

/// The points of a photogrammetric pose, measured once.
std::unique_ptr<MeasurementModel> points_of(const PoseMeasurement& pose) {
  if (pose.photogrammetry.empty()) return nullptr;
  PointsMeasurement points;
  points.targets = pose.photogrammetry;
  points.noise = GaussianNoise{pose.point_sigma * pose.point_sigma * Eigen::Matrix3d::Identity()};
  MeasurementSpec spec;
  spec.instrument = points;
  return std::make_unique<PointsModel>(spec);
}

}  // namespace

PoseModel::PoseModel(const MeasurementSpec& spec)
    : spec_(std::get<PoseMeasurement>(spec.instrument)),
      points_(points_of(spec_)),
      repeats_(spec.repeats),
      repeatability_(spec.repeatability) {
  rows_ = int(spec_.components.size());
}

void PoseModel::rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                               Eigen::Ref<Eigen::MatrixXd> rows) const {
  const Eigen::Vector3d p = sighting.X_MeasureTip.translation();
  Eigen::Index row = 0;
  for (const int c : spec_.components) {
    const int a = (c + 1) % 3, b = (c + 2) % 3;
    for (Eigen::Index j = 0; j < twists.cols(); ++j)
      rows(row, j) = c < 3 ? twists(c, j) + twists(3 + a, j) * p[b] - twists(3 + b, j) * p[a] : twists(c, j);
    ++row;
  }
}

void PoseModel::covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const {
  const Eigen::Matrix<double, 6, 6> full =
      points_ == nullptr ? spec_.covariance : fitted_pose_covariance(*points_, sighting.X_MeasureTip);
  for (Eigen::Index i = 0; i < rows_; ++i) {
    for (Eigen::Index j = 0; j < rows_; ++j)
      covariance(i, j) = full(spec_.components[std::size_t(i)], spec_.components[std::size_t(j)]) / repeats_;
    if (spec_.components[std::size_t(i)] < 3) covariance(i, i) += repeatability_ * repeatability_;
  }
}

}  // namespace posewright
