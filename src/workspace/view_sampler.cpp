#include "view_sampler.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

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

/// ∂ error_of(X, wanted) along a spatial twist of X: E = wanted Xᵀ turns by log(E e^{−ω}) = log E − J_r⁻¹(log E) ω.
Error error_along(const Eigen::Matrix<double, 6, 1>& twist, const Eigen::Isometry3d& X, const Error& error) {
  const Eigen::Vector3d turn = error.tail<3>(), omega = twist.tail<3>();
  const double angle = turn.norm();
  const double second = angle < 1e-4 ? 1.0 / 12 : (1 / angle - 0.5 / std::tan(angle / 2)) / angle;
  Error e;
  e << -(twist.head<3>() + omega.cross(X.translation())) / unit,
      -(omega + 0.5 * turn.cross(omega) + second * turn.cross(turn.cross(omega)));
  return e;
}

}  // namespace

ViewSampler::ViewSampler(const IdentificationModel& model, const LineOfSight& sight,
                         const std::vector<Coordinate>& coordinates)
    : model_(model), sight_(sight), coordinates_(coordinates) {
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    if (!coordinates[k].discrete()) moving_.push_back(k);
}

void ViewSampler::fill_jacobian(std::span<const double> q, const Eigen::Isometry3d& X, const Eigen::Isometry3d& wanted,
                                const Error& error, std::vector<double>& trial,
                                Eigen::Matrix<double, 6, Eigen::Dynamic>& J) const {
  static thread_local Eigen::Matrix<double, 6, Eigen::Dynamic> twists;
  // Readings of a parallel robot are those of its actuators.
  const bool known = model_.actuators().empty() && model_.reading_twists(q, twists);
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const auto column = Eigen::Index(moving_[k]);
    if (known && column < twists.cols()) {
      J.col(Eigen::Index(k)) = error_along(twists.col(column), X, error);
      continue;
    }
    std::copy(q.begin(), q.end(), trial.begin());
    trial[moving_[k]] += step;
    J.col(Eigen::Index(k)) = (error_of(model_.tool_pose(trial), wanted) - error) / step;
  }
}

bool ViewSampler::move_to_view(std::span<double> q, Random& random) const {
  const Eigen::Isometry3d wanted = sight_.propose_tip(q, random);
  Eigen::Isometry3d X = model_.tool_pose(q);
  Error error = error_of(X, wanted);
  Eigen::Matrix<double, 6, Eigen::Dynamic> J(6, Eigen::Index(moving_.size()));
  std::vector<double> trial(q.begin(), q.end());
  double damping = 0.01;
  for (int i = 0; i < most_steps && error.norm() > close_enough; ++i) {
    fill_jacobian(q, X, wanted, error, trial, J);
    Eigen::MatrixXd normal = J.transpose() * J;
    normal.diagonal().array() += damping;
    const Eigen::VectorXd move = normal.llt().solve(J.transpose() * -error);
    std::copy(q.begin(), q.end(), trial.begin());
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const Coordinate& c = coordinates_[moving_[k]];
      trial[moving_[k]] = std::clamp(q[moving_[k]] + move[Eigen::Index(k)], c.lower, c.upper);
    }
    const Eigen::Isometry3d moved = model_.tool_pose(trial);
    const Error there = error_of(moved, wanted);
    if (there.squaredNorm() < error.squaredNorm()) {
      const bool stuck = there.norm() > (1 - least_gain) * error.norm();
      std::copy(trial.begin(), trial.end(), q.begin());
      X = moved;
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
