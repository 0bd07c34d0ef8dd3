#include "posewright/model/measure_points.hpp"

namespace posewright {
namespace {

constexpr double default_target_tolerance = 1e-3;  // m

}  // namespace

PointsModel::PointsModel(const MeasurementSpec& spec)
    : spec_(std::get<PointsMeasurement>(spec.instrument)), repeats_(spec.repeats), repeatability_(spec.repeatability) {
  rows_ = int(spec_.targets.size() * spec_.components.size());
  for (const TargetSpec& target : spec_.targets)
    for (int k = 0; k < 3; ++k)
      parameters_.push_back({"target." + target.name + "." + "xyz"[k], "m", target.position[k],
                             default_target_tolerance, Role::interest});
}

void PointsModel::rows_of_twists(const Eigen::Isometry3d& X, std::span<const double> correction,
                                 const Eigen::Ref<const Twists>& twists, Eigen::Ref<Eigen::MatrixXd> rows) const {
  Eigen::Index row = 0;
  for (std::size_t t = 0; t < spec_.targets.size(); ++t) {
    Eigen::Vector3d p_TipTarget = spec_.targets[t].position;
    if (!correction.empty()) p_TipTarget += Eigen::Map<const Eigen::Vector3d>(correction.data() + 3 * t);
    const Eigen::Vector3d p = X * p_TipTarget;
    for (const int c : spec_.components) {
      // Component c of v + ω × p.
      const int a = (c + 1) % 3, b = (c + 2) % 3;
      for (Eigen::Index j = 0; j < twists.cols(); ++j)
        rows(row, j) = twists(c, j) + twists(3 + a, j) * p[b] - twists(3 + b, j) * p[a];
      ++row;
    }
  }
}

void PointsModel::own_column(const Eigen::Isometry3d& X, std::span<const double>, int index,
                             Eigen::Ref<Eigen::VectorXd> column) const {
  column.setZero();
  const auto width = Eigen::Index(spec_.components.size());
  for (Eigen::Index c = 0; c < width; ++c)
    column[index / 3 * width + c] = X.linear()(spec_.components[std::size_t(c)], index % 3);
}

void PointsModel::covariance(const Eigen::Isometry3d&, std::span<const double>,
                             Eigen::Ref<Eigen::MatrixXd> covariance) const {
  covariance.setZero();
  const auto width = Eigen::Index(spec_.components.size());
  for (Eigen::Index i = 0; i < rows_; ++i) {
    const double sigma = spec_.sigma[spec_.components[std::size_t(i % width)]];
    covariance(i, i) = sigma * sigma / repeats_ + repeatability_ * repeatability_;
  }
}

}  // namespace posewright
