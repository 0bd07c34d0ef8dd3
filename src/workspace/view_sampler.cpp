#include "view_sampler.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>

#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

using Error = Eigen::Matrix<double, 6, 1>;

// A proposal need not be met to the last digit: rad, and m by `unit`.
constexpr double close_enough = 0.01;
// Length whose error weighs as much as that of one radian, m.
constexpr double unit = 0.5;
constexpr double step = 1e-6;
constexpr int most_steps = 40;
// A step that takes away less than this share of the error leads nowhere: the view is out of reach.
constexpr double least_gain = 0.02;

Error error_of(const Eigen::Isometry3d& X, const Eigen::Isometry3d& wanted) {
  const Eigen::AngleAxisd turn(wanted.linear() * X.linear().transpose());
  Error e;
  e << (wanted.translation() - X.translation()) / unit, turn.angle() * turn.axis();
  return e;
}

}  // namespace

ViewSampler::ViewSampler(const IdentificationModel& model, const LineOfSight& sight,
                         const std::vector<Coordinate>& coordinates)
    : model_(model), sight_(sight), coordinates_(coordinates) {
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    if (!coordinates[k].discrete()) moving_.push_back(k);
}

bool ViewSampler::move_to_view(std::span<double> q, Random& random) const {
  const Eigen::Isometry3d wanted = sight_.propose_tip(q, random);
  Error error = error_of(model_.tool_pose(q), wanted);
  Eigen::Matrix<double, 6, Eigen::Dynamic> J(6, Eigen::Index(moving_.size()));
  std::vector<double> trial(q.begin(), q.end());
  double damping = 0.01;
  for (int i = 0; i < most_steps && error.norm() > close_enough; ++i) {
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      std::copy(q.begin(), q.end(), trial.begin());
      trial[moving_[k]] += step;
      J.col(Eigen::Index(k)) = (error_of(model_.tool_pose(trial), wanted) - error) / step;
    }
    Eigen::MatrixXd normal = J.transpose() * J;
    normal.diagonal().array() += damping;
    const Eigen::VectorXd move = normal.llt().solve(J.transpose() * -error);
    std::copy(q.begin(), q.end(), trial.begin());
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const Coordinate& c = coordinates_[moving_[k]];
      trial[moving_[k]] = std::clamp(q[moving_[k]] + move[Eigen::Index(k)], c.lower, c.upper);
    }
    const Error there = error_of(model_.tool_pose(trial), wanted);
    if (there.squaredNorm() < error.squaredNorm()) {
      const bool stuck = there.norm() > (1 - least_gain) * error.norm();
      std::copy(trial.begin(), trial.end(), q.begin());
      error = there;
      damping = std::max(1e-6, damping / 10);
      if (stuck) break;
    } else {
      damping *= 10;
    }
    if (damping > 1e4) break;
  }
  return error.norm() <= close_enough;
}

}  // namespace posewright
