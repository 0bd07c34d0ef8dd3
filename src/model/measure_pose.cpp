#include "posewright/model/measure_pose.hpp"

#include <stdexcept>

namespace posewright {

PoseModel::PoseModel(const MeasurementSpec& spec)
    : spec_(std::get<PoseMeasurement>(spec.instrument)), repeats_(spec.repeats), repeatability_(spec.repeatability) {
  rows_ = int(spec_.components.size());
}

void PoseModel::rows_of_twists(const Eigen::Isometry3d& X, std::span<const double>,
                               const Eigen::Ref<const Twists>& twists, Eigen::Ref<Eigen::MatrixXd> rows) const {
  const Eigen::Vector3d p = X.translation();
  Eigen::Index row = 0;
  for (const int c : spec_.components) {
    const int a = (c + 1) % 3, b = (c + 2) % 3;
    for (Eigen::Index j = 0; j < twists.cols(); ++j)
      rows(row, j) = c < 3 ? twists(c, j) + twists(3 + a, j) * p[b] - twists(3 + b, j) * p[a] : twists(c, j);
    ++row;
  }
}

void PoseModel::own_column(const Eigen::Isometry3d&, std::span<const double>, int, Eigen::Ref<Eigen::VectorXd>) const {
  throw std::logic_error("pose measurement has no parameters of its own");
}

void PoseModel::covariance(const Eigen::Isometry3d&, std::span<const double>,
                           Eigen::Ref<Eigen::MatrixXd> covariance) const {
  covariance.setZero();
  for (Eigen::Index i = 0; i < rows_; ++i) {
    const bool position = spec_.components[std::size_t(i)] < 3;
    const double sigma = position ? spec_.position_sigma : spec_.rotation_sigma;
    covariance(i, i) = sigma * sigma / repeats_ + (position ? repeatability_ * repeatability_ : 0.0);
  }
}

}  // namespace posewright
