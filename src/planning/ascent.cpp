#include "posewright/planning/ascent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlopt.hpp>
#include <stdexcept>
#include <tuple>

#include "posewright/planning/block_gradient.hpp"

namespace posewright {
namespace {

// Where SLSQP and SBPLX stop: relative change of the coordinates, in units of their range.
constexpr double coordinate_tolerance = 1e-7;
// Searches end this far within the margins, in their units; step of the margins' central differences, in units of the
// range; a margin where there is none.
constexpr double kept_margin = 1e-6, margin_step = 1e-6, no_margin = -0.1;
// A look around without gradient takes this part of the evaluations.
constexpr int look_around = 2;
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
        gradient_(space, rows, columns),
        moving_(gradient_.moving()),
        margin_count_(std::size_t(space.margins().value_or(0))),
        above_(margin_count_),
        below_(margin_count_),
        q_(start) {
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

  /// True if the smooth bounds of the feasible set are known: then f counts beyond them too, and margins() holds the
  /// search.
  bool follows_margins() const { return margin_count_ > 0; }
  std::size_t margin_count() const { return margin_count_; }

  /// From now on beyond them there is nothing, and nothing below what is reached counts.
  void leave_margins() {
    margin_count_ = 0;
    floor_ = highest_ = best_.value;
  }

  /// Constraints ≤ 0: the margins less a little, so that their boundary is still feasible; and their derivatives by u.
  void bounds(const std::vector<double>& u, double* result, double* gradient) {
    place(u);
    margins_at(q_, result);
    if (gradient == nullptr) return;
    std::vector<double> near = q_;
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      const std::size_t k = moving_[i];
      const double up = std::min(axes_[k].upper, q_[k] + margin_step * width(k)),
                   down = std::max(axes_[k].lower, q_[k] - margin_step * width(k));
      near[k] = up;
      margins_at(near, above_.data());
      near[k] = down;
      margins_at(near, below_.data());
      near[k] = q_[k];
      for (std::size_t m = 0; m < margin_count_; ++m)
        gradient[m * moving_.size() + i] = (above_[m] - below_[m]) / (up - down) * width(k);
    }
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
  /// Without values, no point is feasible.
  void margins_at(std::span<const double> q, double* result) {
    if (!probe_.margins(q, std::span(result, margin_count_))) std::fill_n(result, margin_count_, no_margin);
    for (std::size_t m = 0; m < margin_count_; ++m) result[m] = kept_margin - result[m];
  }

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
    if (!probe_.perhaps_feasible(q_)) return follows_margins() ? value : infeasible;
    if (value > highest_ && (!accept_ || accept_(q_))) {
      highest_ = value;
      improvements_.emplace_back(value, q_);
    }
    return value;
  }

  void differentiate(double value, std::vector<double>& gradient) {
    std::fill(gradient.begin(), gradient.end(), 0.0);
    if (!std::isfinite(value)) return;
    slope_.noalias() = 2 * block_.map() * objective_.gradient(block_.map());
    gradient_.at(probe_, q_, slope_, gradient);
  }

  const std::vector<ConfigurationSpace::Axis>& axes_;
  ConfigurationSpace::Probe& probe_;
  BlockObjective& objective_;
  const std::function<bool(std::span<const double>)>& accept_;
  ProbedBlock block_;
  BlockGradient gradient_;
  BlockArray::RowMatrix slope_;
  const std::vector<std::size_t>& moving_;
  std::size_t margin_count_;
  std::vector<double> above_, below_;
  std::vector<double> q_;
  AscentResult best_;
  std::vector<std::pair<double, std::vector<double>>> improvements_;  // each higher than the one before
  double floor_ = 0.0, highest_ = 0.0;
};

void call_bounds(unsigned, double* result, unsigned size, const double* u, double* gradient, void* data) {
  static_cast<Evaluator*>(data)->bounds({u, u + size}, result, gradient);
}

double call(const std::vector<double>& u, std::vector<double>& gradient, void* data) {
  return (*static_cast<Evaluator*>(data))(u, gradient);
}

void run(nlopt::algorithm algorithm, Evaluator& evaluator, int evaluations) {
  std::vector<double> u = evaluator.unit_start();
  nlopt::opt method(algorithm, unsigned(u.size()));
  method.set_lower_bounds(0.0);
  method.set_upper_bounds(1.0);
  method.set_max_objective(call, &evaluator);
  method.set_xtol_abs(coordinate_tolerance);
  method.set_maxeval(evaluations);
  if (algorithm == nlopt::LN_SBPLX) method.set_initial_step(first_step);
  if (evaluator.follows_margins())
    method.add_inequality_mconstraint(call_bounds, &evaluator, std::vector<double>(evaluator.margin_count(), 0.0));
  double value = 0.0;
  try {
    method.optimize(u, value);
  } catch (const nlopt::roundoff_limited&) {
    // As good as the arithmetic allows: the best configuration seen stands.
  } catch (const std::runtime_error&) {
    // NLopt's "generic failure", e.g. of SLSQP's line search: the same.
  }
}

}  // namespace

AscentResult ascend(const ConfigurationSpace& space, ConfigurationSpace::Probe& probe, BlockObjective& objective,
                    int rows, int columns, std::vector<double> start, int max_evaluations,
                    const std::function<bool(std::span<const double>)>& accept) {
  Evaluator evaluator(space, probe, objective, rows, columns, std::move(start), accept);
  if (!evaluator.can_move()) return evaluator.best();
  const bool smooth = space.margins().has_value();
  run(smooth ? nlopt::LD_SLSQP : nlopt::LN_SBPLX, evaluator, max_evaluations);
  if (!evaluator.follows_margins()) return evaluator.best();
  // Where margins end a search it may have found but the nearest place of many: one without gradient looks around it.
  evaluator.best();
  evaluator.leave_margins();
  run(nlopt::LN_SBPLX, evaluator, max_evaluations / look_around);
  return evaluator.best();
}

}  // namespace posewright
