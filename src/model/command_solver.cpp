#include "posewright/model/command_solver.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "posewright/model/rotation_vector.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// m and rad. Newton's method squares the error, so that most poses end far below.
constexpr double solved = 1e-10;
// Where rounding is all that is left of a step, this is what a solution may miss by.
constexpr double accepted = 1e-8;
constexpr int most_steps = 60;
// No joint moves further in one step, rad or m: what is linear in J does not hold beyond.
constexpr double longest_step = 0.3;
constexpr double first_damping = 1e-3, least_damping = 1e-7, most_damping = 1e2;
// Rad that the tip turns for one of a joint: near a singularity joints would move far for a small turn.
constexpr double worth_a_turn = 0.1;
// A commanded value at a limit differs from it by rounding.
constexpr double limit_rounding = 1e-9;

using Error = Eigen::Matrix<double, 6, 1>;

/// Rotation vector of R; exact for small ones, where the sine of the angle is what R − Rᵀ has.
Eigen::Vector3d turn_of(const Eigen::Matrix3d& R) {
  const Eigen::Vector3d w = 0.5 * Eigen::Vector3d(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  const double sine = w.norm(), cosine = 0.5 * (R.trace() - 1);
  if (cosine < 0) return rotation_vector(R);
  return sine < 1e-9 ? w : Eigen::Vector3d(w * (std::atan2(sine, cosine) / sine));
}

/// Displacement and turn that put X onto the target, axes of M, about the tip.
Error error_of(const Eigen::Isometry3d& target, const Eigen::Isometry3d& X) {
  Error e;
  e << target.translation() - X.translation(), turn_of(target.linear() * X.linear().transpose());
  return e;
}

TipError tip_error(const Error& e) { return {e.head<3>().norm(), e.tail<3>().norm()}; }

}  // namespace

/// Working data of one pose; one per thread.
struct CommandSolver::Work {
  Eigen::Isometry3d target, X;
  Error e;                                     ///< at u; its last three count only where the orientation does
  Eigen::Matrix<double, 6, Eigen::Dynamic> J;  ///< at u, about the tip, axes of M
  Twists twists, none;
  std::vector<double> listed;         ///< configuration as listed
  std::vector<double> q, settled;     ///< configuration at u; of a parallel robot, where it settled last
  Eigen::VectorXd nominal, first, u;  ///< command as listed; the same but for what is held; now
  Eigen::VectorXd before, change, pull;
  std::vector<char> held;  ///< per commanded: at a limit, where it stays
  Eigen::Matrix<double, 6, 6> square;
  Eigen::MatrixXd normal;
  Eigen::Index rows = 6;
};

CommandSolver::Work& CommandSolver::work_of_this_thread() {
  static thread_local Work work;
  return work;
}

CommandSolver::CommandSolver(std::unique_ptr<TipModel> nominal, std::unique_ptr<TipModel> calibrated,
                             std::vector<double> correction, std::vector<Coordinate> limits, const Options& options)
    : nominal_(std::move(nominal)),
      calibrated_(std::move(calibrated)),
      correction_(std::move(correction)),
      limits_(std::move(limits)),
      options_(options) {
  if (correction_.size() != calibrated_->parameters().size() || limits_.size() != calibrated_->coordinates().size())
    throw std::invalid_argument("command solver: corrections and limits of another robot");
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    if (!limits_[i].choice()) ++moving_;
    listed_ = listed_ || (limits_[i].discrete() && !limits_[i].choice());
  }
  commanded_ = calibrated_->actuators();
  if (commanded_.empty()) commanded_.assign(limits_.begin(), limits_.begin() + std::ptrdiff_t(moving_));
  if (commanded_.size() < 6 && !options_.position_only)
    throw CannotDo("this robot has " + std::to_string(commanded_.size()) +
                   " axes, position and orientation of its tip need six; --position-only reaches positions alone");
  calibrated_->take_loads_at(correction_);
  // Base and tool are the first and last factor of the tip's pose: what does not count is left nominal.
  for (std::size_t i = 0; i < correction_.size(); ++i) {
    const std::string& name = calibrated_->parameters()[i].name;
    if ((!options_.with_base && name.starts_with("base.")) || (!options_.with_tool && name.starts_with("tool.")))
      correction_[i] = 0.0;
  }
}

Point CommandSolver::point(std::span<const double> q) const { return {q, correction_, chosen_at(limits_, q)}; }

bool CommandSolver::target(std::span<const double> q, Eigen::Isometry3d& X) const {
  static thread_local Twists none;
  Point at = point(q);
  at.q = q.first(nominal_->coordinates().size());
  at.correction = {};
  return nominal_->linearise(at, {}, X, none, nullptr);
}

bool CommandSolver::reached(std::span<const double> q, Eigen::Isometry3d& X) const {
  static thread_local Twists none;
  return calibrated_->linearise(point(q), {}, X, none, nullptr);
}

/// Pose, error and columns at w.u; false if the robot cannot be there.
bool CommandSolver::evaluate(Work& w) const {
  if (is_parallel()) {
    w.settled = w.q;
    const std::span<const double> u(w.u.data(), std::size_t(w.u.size()));
    if (!calibrated_->configuration_at(u, point(w.settled), w.q)) {
      w.q = w.settled;
      return false;
    }
  } else {
    std::copy_n(w.u.data(), w.u.size(), w.q.begin());
  }
  Point at = point(w.q);
  if (listed_) at.read = w.listed;
  if (!calibrated_->linearise(at, {}, w.X, w.none, &w.twists)) return false;
  w.e = error_of(w.target, w.X);
  w.J.resize(6, w.twists.cols());
  const Eigen::Vector3d p = w.X.translation();
  for (Eigen::Index c = 0; c < w.J.cols(); ++c) {
    const Eigen::Vector3d omega = w.twists.col(c).tail<3>();
    w.J.col(c).head<3>() = w.twists.col(c).head<3>() + omega.cross(p);
    w.J.col(c).tail<3>() = omega;
    if (w.held[std::size_t(c)] != 0) w.J.col(c).setZero();
  }
  return w.e.allFinite();
}

/// The change of u for the position that turns the tip as near as it can, of an arm that has no axes for both.
void CommandSolver::step_for_position(Work& w) const {
  const Eigen::Index n = w.J.cols();
  const auto turn = w.J.bottomRows<3>();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 3, n + 3);
  system.topLeftCorner(n, n) = turn.transpose() * turn;
  system.topLeftCorner(n, n).diagonal().array() += worth_a_turn * worth_a_turn;
  system.topRightCorner(n, 3) = w.J.topRows<3>().transpose();
  system.bottomLeftCorner(3, n) = w.J.topRows<3>();
  Eigen::VectorXd wanted(n + 3);
  wanted << turn.transpose() * w.e.tail<3>() + worth_a_turn * worth_a_turn * (w.first - w.u), w.e.head<3>();
  w.change = Eigen::FullPivLU<Eigen::MatrixXd>(system).solve(wanted).head(n);
}

/// The next change of u. With as many axes as rows or more, the smallest one of all from the nominal command that does
/// it; with fewer, least squares.
void CommandSolver::step(Work& w, double damping) const {
  const auto J = w.J.topRows(w.rows);
  const auto e = w.e.head(w.rows);
  if (w.rows == 3 && J.cols() > 3 && J.cols() < 6 && damping == 0 && !is_parallel()) {
    step_for_position(w);
  } else if (J.cols() >= w.rows) {
    w.square.setIdentity();
    w.square.topLeftCorner(w.rows, w.rows).noalias() = J.lazyProduct(J.transpose());
    w.square.diagonal().array() += damping * damping;
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(w.square);
    Error wanted = Error::Zero();
    wanted.head(w.rows) = e;
    w.pull = w.first - w.u;
    if (damping > 0) w.pull.setZero();
    wanted.head(w.rows) -= J.lazyProduct(w.pull);
    const Error multiplier = factor.solve(wanted);
    w.change = w.pull + J.transpose().lazyProduct(multiplier.head(w.rows));
  } else {
    w.normal.noalias() = J.transpose().lazyProduct(J);
    w.normal.diagonal().array() += damping * damping;
    w.change = Eigen::LDLT<Eigen::MatrixXd>(w.normal).solve(J.transpose().lazyProduct(e));
  }
  if (!w.change.allFinite()) w.change.setZero();
  if (const double most = w.change.cwiseAbs().maxCoeff(); most > longest_step) w.change *= longest_step / most;
}

/// From w.u, already evaluated, to where the error is nothing; false if it does not get there.
bool CommandSolver::iterate(Work& w) const {
  const auto size = [&] { return w.e.head(w.rows).cwiseAbs().maxCoeff(); };
  double damping = 0, error = w.e.head(w.rows).norm();
  for (int k = 0; k < most_steps && size() > solved && damping < most_damping; ++k) {
    step(w, damping);
    if (!(w.change.cwiseAbs().maxCoeff() > 1e-15)) break;
    w.before = w.u;
    w.u += w.change;
    const bool there = evaluate(w);
    const double now = there ? w.e.head(w.rows).norm() : error;
    if (there && now < error) {
      error = now;
      damping = damping < least_damping ? 0 : damping / 10;
      continue;
    }
    w.u = w.before;
    if (!evaluate(w)) return false;
    damping = damping > 0 ? damping * 10 : first_damping;
    if (size() < accepted) break;
  }
  return size() <= accepted;
}

/// Holds joints of a redundant arm that are beyond a limit there; false if none is or too few axes are to spare.
bool CommandSolver::hold_at_limits(Work& w) const {
  const auto beyond = [&](std::size_t i) {
    const Coordinate& c = commanded_[i];
    const double value = w.u[Eigen::Index(i)];
    return w.held[i] == 0 && !c.periodic && (value < c.lower || value > c.upper);
  };
  Eigen::Index more = 0, free = 0;
  for (std::size_t i = 0; i < commanded_.size(); ++i) {
    more += beyond(i) ? 1 : 0;
    free += w.held[i] == 0 ? 1 : 0;
  }
  if (more == 0 || free - more < w.rows) return false;
  for (std::size_t i = 0; i < commanded_.size(); ++i) {
    if (!beyond(i)) continue;
    w.held[i] = 1;
    const auto k = Eigen::Index(i);
    w.u[k] = w.first[k] = std::clamp(w.u[k], commanded_[i].lower, commanded_[i].upper);
  }
  return true;
}

/// The configuration to command; false if a parallel robot's controller has none for these actuators.
bool CommandSolver::command(Work& w, std::span<const double> q, std::span<double> configuration) const {
  std::copy(q.begin(), q.end(), configuration.begin());
  const std::span<const double> u(w.u.data(), std::size_t(w.u.size()));
  if (!is_parallel()) {
    std::copy(u.begin(), u.end(), configuration.begin());
    return true;
  }
  Point start = point(q);
  start.correction = {};
  return nominal_->configuration_at(u, start, configuration);
}

void CommandSolver::judge(const Work& w, std::span<const double> configuration, Solution& solution) const {
  const auto blame = [&](Outcome outcome, std::size_t i, double value) {
    solution.outcome = outcome;
    solution.coordinate = int(i);
    solution.value = value;
  };
  for (std::size_t i = 0; i < commanded_.size(); ++i) {
    const double change = w.u[Eigen::Index(i)] - w.nominal[Eigen::Index(i)];
    if (std::abs(change) > (commanded_[i].unit == "m" ? options_.most_length : options_.most_angle))
      return blame(Outcome::too_far, i, change);
  }
  const auto beyond = [](const Coordinate& c, double value) {
    return !c.choice() && !c.periodic && (value < c.lower - limit_rounding || value > c.upper + limit_rounding);
  };
  for (std::size_t i = 0; i < commanded_.size(); ++i)
    if (beyond(commanded_[i], w.u[Eigen::Index(i)])) return blame(Outcome::beyond_limit, i, w.u[Eigen::Index(i)]);
  if (!is_parallel()) return;
  for (std::size_t i = 0; i < moving_; ++i)
    if (beyond(limits_[i], configuration[i]))
      return blame(Outcome::beyond_limit, commanded_.size() + i, configuration[i]);
}

CommandSolver::Solution CommandSolver::solve(std::span<const double> q, std::span<double> configuration,
                                             std::span<double> change, std::span<double> actuators) const {
  Work& w = work_of_this_thread();
  Solution solution;
  std::copy(q.begin(), q.end(), configuration.begin());
  std::fill(change.begin(), change.end(), 0.0);
  w.rows = options_.position_only ? 3 : 6;
  w.q.assign(q.begin(), q.end());
  w.listed.assign(q.begin(), q.end());
  w.held.assign(commanded_.size(), 0);
  w.first.resize(Eigen::Index(commanded_.size()));
  solution.outcome = Outcome::out_of_reach;
  if (!target(q, w.target)) return solution;
  if (is_parallel()) {
    Point at = point(q);
    at.correction = {};
    if (!nominal_->actuator_values(at, {w.first.data(), std::size_t(w.first.size())})) return solution;
  } else {
    std::copy_n(q.begin(), commanded_.size(), w.first.data());
  }
  solution.outcome = Outcome::no_solution;
  w.u = w.nominal = w.first;
  if (!evaluate(w)) return solution;
  solution.before = tip_error(w.e);
  bool found = iterate(w);
  while (found && commanded_.size() > std::size_t(w.rows) && hold_at_limits(w)) found = evaluate(w) && iterate(w);
  solution.after = tip_error(w.e);
  if (!found || !command(w, q, configuration)) {
    std::copy(q.begin(), q.end(), configuration.begin());
    return solution;
  }
  solution.outcome = Outcome::reached;
  judge(w, configuration, solution);
  if (solution.outcome != Outcome::reached) {
    std::copy(q.begin(), q.end(), configuration.begin());
    return solution;
  }
  for (std::size_t i = 0; i < change.size(); ++i) change[i] = w.u[Eigen::Index(i)] - w.nominal[Eigen::Index(i)];
  for (std::size_t i = 0; i < actuators.size(); ++i) actuators[i] = w.u[Eigen::Index(i)];
  return solution;
}

}  // namespace posewright
