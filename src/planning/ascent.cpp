#include "posewright/planning/ascent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlopt.hpp>
#include <stdexcept>
#include <tuple>

namespace posewright {
namespace {

// Where SLSQP and SBPLX stop: relative change of the coordinates, in units of their range.
constexpr double coordinate_tolerance = 1e-7;
// Step of the central differences, in units of the range: the error of the derivative is about its square.
constexpr double difference_step = 1e-5;
// First step of SBPLX, in units of the range.
constexpr double first_step = 0.05;

/// f on the unit box of the continuous axes; keeps what improved on the start.
class Evaluator {
 public:
  Evaluator(const ConfigurationSpace& space, ConfigurationSpace::Probe& probe, BlockObjective& objective, int rows,
            int columns, std::vector<double> start, const std::function<bool(std::span<const double>)>& accept)
      : axes_(space.axes()),
        probe_(probe),
        objective_(objective),
        accept_(accept),
        block_(rows, columns),
        low_(rows, columns),
        high_(rows, columns),
        q_(start) {
    for (std::size_t k = 0; k < axes_.size(); ++k)
      if (axes_[k].continuous && axes_[k].upper > axes_[k].lower) moving_.push_back(k);
    best_.q = std::move(start);
    best_.value = -std::numeric_limits<double>::infinity();
    if (probe_.perhaps_feasible(q_) && block_.at(probe_, q_)) best_.value = objective_.value(block_.map());
    floor_ = highest_ = best_.value;
  }

  std::vector<double> unit_start() const {
    std::vector<double> u;
    for (const std::size_t k : moving_) u.push_back(std::clamp((best_.q[k] - axes_[k].lower) / width(k), 0.0, 1.0));
    return u;
  }

  double operator()(const std::vector<double>& u, std::vector<double>& gradient) {
    ++best_.evaluations;
    place(u);
    const double value = evaluate();
    if (!gradient.empty()) differentiate(value, gradient);
    // Worse than the start, so that no step to here is taken; finite, because the methods subtract values.
    return std::isfinite(value) ? value : floor_ - 1 - std::abs(floor_);
  }

  /// The highest that is feasible in every respect: what takes long to check is asked of few.
  const AscentResult& best() {
    for (; !improvements_.empty(); improvements_.pop_back()) {
      if (!probe_.feasible(improvements_.back().second)) continue;
      std::tie(best_.value, best_.q) = improvements_.back();
      break;
    }
    improvements_.clear();
    return best_;
  }
  bool can_move() const { return !moving_.empty() && std::isfinite(best_.value); }

 private:
  double width(std::size_t k) const { return axes_[k].upper - axes_[k].lower; }

  void place(const std::vector<double>& u) {
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      const std::size_t k = moving_[i];
      q_[k] = u[i] >= 1.0 ? axes_[k].upper : std::max(axes_[k].lower, axes_[k].lower + u[i] * width(k));
    }
  }

  double evaluate() {
    constexpr double infeasible = -std::numeric_limits<double>::infinity();
    if (!block_.at(probe_, q_)) return infeasible;
    const double value = objective_.value(block_.map());
    // No step is taken to where it is worse than at the start: whether one could, nobody needs to know.
    if (value <= floor_) return value;
    if (!probe_.perhaps_feasible(q_)) return infeasible;
    if (value > highest_ && (!accept_ || accept_(q_))) {
      highest_ = value;
      improvements_.emplace_back(value, q_);
    }
    return value;
  }

  void differentiate(double value, std::vector<double>& gradient) {
    std::fill(gradient.begin(), gradient.end(), 0.0);
    if (!std::isfinite(value)) return;
    const BlockArray::RowMatrix slope = 2 * block_.map() * objective_.gradient(block_.map());
    std::vector<double> near = q_;
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      const std::size_t k = moving_[i];
      const double step = difference_step * width(k);
      const double up = std::min(axes_[k].upper, q_[k] + step), down = std::max(axes_[k].lower, q_[k] - step);
      near[k] = up;
      const bool there = high_.at(probe_, near);
      near[k] = down;
      const bool here = low_.at(probe_, near);
      near[k] = q_[k];
      if (there && here) gradient[i] = slope.cwiseProduct(high_.map() - low_.map()).sum() / (up - down) * width(k);
    }
  }

  const std::vector<ConfigurationSpace::Axis>& axes_;
  ConfigurationSpace::Probe& probe_;
  BlockObjective& objective_;
  const std::function<bool(std::span<const double>)>& accept_;
  ProbedBlock block_, low_, high_;
  std::vector<double> q_;
  std::vector<std::size_t> moving_;
  AscentResult best_;
  std::vector<std::pair<double, std::vector<double>>> improvements_;  // each higher than the one before
  double floor_ = 0.0, highest_ = 0.0;
};

double call(const std::vector<double>& u, std::vector<double>& gradient, void* data) {
  return (*static_cast<Evaluator*>(data))(u, gradient);
}

}  // namespace

AscentResult ascend(const ConfigurationSpace& space, ConfigurationSpace::Probe& probe, BlockObjective& objective,
                    int rows, int columns, std::vector<double> start, int max_evaluations,
                    const std::function<bool(std::span<const double>)>& accept) {
  Evaluator evaluator(space, probe, objective, rows, columns, std::move(start), accept);
  if (!evaluator.can_move()) return evaluator.best();
  std::vector<double> u = evaluator.unit_start();
  nlopt::opt method(space.is_box() ? nlopt::LD_SLSQP : nlopt::LN_SBPLX, unsigned(u.size()));
  method.set_lower_bounds(0.0);
  method.set_upper_bounds(1.0);
  method.set_max_objective(call, &evaluator);
  method.set_xtol_abs(coordinate_tolerance);
  method.set_maxeval(max_evaluations);
  if (!space.is_box()) method.set_initial_step(first_step);
  double value = 0.0;
  try {
    method.optimize(u, value);
  } catch (const nlopt::roundoff_limited&) {
    // As good as the arithmetic allows: the best configuration seen stands.
  } catch (const std::runtime_error&) {
    // NLopt's "generic failure", e.g. of SLSQP's line search: the same.
  }
  return evaluator.best();
}

}  // namespace posewright
