#include "tip_mover.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "posewright/model/instrument_choice.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

using Error = Eigen::Matrix<double, 6, 1>;

// Length whose error weighs as much as that of one radian, m.
constexpr double unit = 0.5;
constexpr double step = 1e-6;
constexpr int most_steps = 40;
// A step that takes away less than this share of the error leads nowhere: the pose is out of reach.
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

/// Tips at one configuration.
struct TipMover::Work {
  std::span<const TipGoal> goals;
  std::vector<std::size_t> moving;
  std::vector<Eigen::Isometry3d> X;
  std::vector<Error> errors;  ///< of each goal, all components
  Eigen::VectorXd e;          ///< components of all goals
  Eigen::MatrixXd J;
  std::vector<double> there;  ///< q with the instrument of a goal
};

TipMover::TipMover(const IdentificationModel& model, const std::vector<Coordinate>& coordinates)
    : model_(model), coordinates_(coordinates), instrument_(instrument_index(coordinates)) {}

void TipMover::place(Work& w, std::span<const double> q) const {
  w.there.assign(q.begin(), q.end());
  Eigen::Index row = 0;
  for (std::size_t g = 0; g < w.goals.size(); ++g) {
    if (instrument_ && w.goals[g].instrument) w.there[*instrument_] = *w.goals[g].instrument;
    w.X[g] = model_.tool_pose(w.there);
    w.errors[g] = error_of(w.X[g], w.goals[g].wanted);
    for (const int c : w.goals[g].components) w.e[row++] = w.errors[g][c];
  }
}

void TipMover::fill_jacobian(Work& w, std::span<const double> q) const {
  static thread_local Eigen::Matrix<double, 6, Eigen::Dynamic> twists;
  w.there.assign(q.begin(), q.end());
  Eigen::Index row = 0;
  for (std::size_t g = 0; g < w.goals.size(); ++g) {
    const TipGoal& goal = w.goals[g];
    if (instrument_ && goal.instrument) w.there[*instrument_] = *goal.instrument;
    // Readings of a parallel robot are those of its actuators.
    const bool known = model_.actuators().empty() && model_.reading_twists(w.there, twists);
    for (std::size_t k = 0; k < w.moving.size(); ++k) {
      const auto column = Eigen::Index(w.moving[k]);
      Error slope;
      if (known && column < twists.cols()) {
        slope = error_along(twists.col(column), w.X[g], w.errors[g]);
      } else {
        const double at = w.there[w.moving[k]];
        w.there[w.moving[k]] = at + step;
        slope = (error_of(model_.tool_pose(w.there), goal.wanted) - w.errors[g]) / step;
        w.there[w.moving[k]] = at;
      }
      for (std::size_t c = 0; c < goal.components.size(); ++c)
        w.J(row + Eigen::Index(c), Eigen::Index(k)) = slope[goal.components[c]];
    }
    row += Eigen::Index(goal.components.size());
  }
}

bool TipMover::move(std::span<double> q, std::span<const TipGoal> goals, double near,
                    std::span<const char> held) const {
  Work w{goals, {}, std::vector<Eigen::Isometry3d>(goals.size()), std::vector<Error>(goals.size()), {}, {}, {}};
  for (std::size_t k = 0; k < coordinates_.size(); ++k)
    if (!coordinates_[k].discrete() && (held.empty() || !held[k])) w.moving.push_back(k);
  std::size_t rows = 0;
  for (const TipGoal& goal : goals) rows += goal.components.size();
  w.e.resize(Eigen::Index(rows));
  w.J.resize(Eigen::Index(rows), Eigen::Index(w.moving.size()));
  place(w, q);
  Work moved = w;
  std::vector<double> trial(q.begin(), q.end());
  double damping = 0.01;
  for (int i = 0; i < most_steps && w.e.norm() > near; ++i) {
    fill_jacobian(w, q);
    Eigen::MatrixXd normal = w.J.transpose() * w.J;
    normal.diagonal().array() += damping;
    const Eigen::VectorXd move = normal.llt().solve(w.J.transpose() * -w.e);
    std::copy(q.begin(), q.end(), trial.begin());
    for (std::size_t k = 0; k < w.moving.size(); ++k) {
      const Coordinate& c = coordinates_[w.moving[k]];
      trial[w.moving[k]] = std::clamp(q[w.moving[k]] + move[Eigen::Index(k)], c.lower, c.upper);
    }
    place(moved, trial);
    if (moved.e.squaredNorm() < w.e.squaredNorm()) {
      const bool stuck = moved.e.norm() > (1 - least_gain) * w.e.norm();
      std::copy(trial.begin(), trial.end(), q.begin());
      std::swap(w.X, moved.X);
      std::swap(w.errors, moved.errors);
      std::swap(w.e, moved.e);
      damping = std::max(1e-6, damping / 10);
      if (stuck) break;
    } else {
      damping *= 10;
    }
    if (damping > 1e4) break;
  }
  return w.e.norm() <= near;
}

}  // namespace posewright
