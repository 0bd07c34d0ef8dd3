#include "posewright/calibration/profile.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "minimise.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();
// Relative: of a sum of a thousand it leaves τ² right to a millionth.
constexpr double end_of_refit = 1e-9;
constexpr int most_evaluations = 60;
// τ is this near to what was asked, relatively, at an end of the interval: so near is the end to where it belongs.
constexpr double near_enough = 3e-4;
constexpr int most_refits = 60;
// An interval so many times as long as the linear one has no end.
constexpr double longest = 50.0;
// A step outwards is longer than the last one by this at least and at most, and aims a little too far.
constexpr double shortest_step = 1.05, longest_step = 2.0, aim = 1.02;
// False position keeps so far away from both ends.
constexpr double margin = 0.02;
// So many σ away the linear problem may know no longer where the others go.
constexpr double linear_start = 3.0;
constexpr int steps_of_a_path = 6;
// So far below the estimate's a sum of squares is another minimum and not rounding.
constexpr double below = 1e-4;

}  // namespace

class Profile::State {
 public:
  State(const IdentificationModel& model, const VariantColumns& chosen, const std::vector<MeasuredPose>& poses,
        const FitOptions& options, const Fit& fit)
      : columns_(chosen), stacked_(model, columns_, poses, options.prior, fit.correction), estimate(stacked_.start()) {
    if (options.weighting == Weighting::robust) throw CannotDo("profiles are not for robust weights");
    const Eigen::VectorXd unit = stacked_.tolerances().cwiseInverse();
    covariance = unit.asDiagonal() * fit.covariance * unit.asDiagonal();
    stacked_.limit(options.limits);
    stacked_.set_spreads(spreads_of(columns_, fit.spreads));
    stacked_.correlate(options.effect);
    stacked_.weigh(estimate, options.weighting);
    stacked_.set_noise_factor(fit.scale_known ? fit.noise_factor : fit.scale);
    Eigen::VectorXd f;
    if (!stacked_.residual(estimate, f)) throw CannotDo("the solution is out of the robot's reach");
    least = f.squaredNorm();
  }

  double tolerance(int column) const { return stacked_.tolerances()[column]; }
  double sigma(int column) const { return std::sqrt(covariance(column, column)); }

  /// Values of all columns in the linear problem for a given value of one.
  Eigen::VectorXd along(int column, double change) const {
    return estimate + covariance.col(column) * (change / covariance(column, column));
  }

  /// |τ| of a change of one column, by the linear problem's start. Where that is far away or leads nowhere: from the
  /// estimate itself, too, and in steps.
  std::optional<double> farther(int column, double change, const Monitor& monitor) {
    Eigen::VectorXd x = along(column, change);
    std::optional<double> least_tau = refit(column, x, monitor);
    if (least_tau && std::abs(change) < linear_start * sigma(column)) return least_tau;
    for (const int steps : {1, steps_of_a_path}) {
      x = estimate;
      std::optional<double> tau;
      for (int step = 1; step <= steps; ++step) {
        x[column] = estimate[column] + change * step / steps;
        tau = refit(column, x, monitor);
        if (!tau) break;
      }
      if (tau && (!least_tau || *tau < *least_tau)) least_tau = tau;
    }
    return least_tau;
  }

  /// |τ| where one column stays and the others end from x on; none as Profile::tau().
  std::optional<double> refit(int column, Eigen::VectorXd& x, const Monitor& monitor) {
    int evaluations = 0;
    const MinimiseOptions options{end_of_refit, most_evaluations, column, &monitor};
    Eigen::VectorXd f;
    if (!stacked_.residual(x, f) || !minimise(stacked_, options, x, evaluations) || !stacked_.residual(x, f))
      return std::nullopt;
    const double rise = f.squaredNorm() - least;
    if (-rise > std::max(better, below)) {
      better = -rise;
      better_estimate = stacked_.correction_of(x);
    }
    return std::sqrt(std::max(rise, 0.0));
  }

 private:
  const VariantColumns columns_;
  StackedReadings stacked_;

 public:
  const Eigen::VectorXd estimate;  ///< in units of tolerance
  Eigen::MatrixXd covariance;      ///< of it
  double least = 0.0, better = 0.0;
  std::vector<double> better_estimate;
};

/// One side of an interval. Steps are in units of tolerance, away from the estimate.
class Profile::Side {
 public:
  Side(State& state, int column, double sign, double factor, const Monitor& monitor)
      : state_(state),
        column_(column),
        sign_(sign),
        factor_(factor),
        half_(factor * state.sigma(column)),
        monitor_(monitor),
        within_{0.0, 0.0, state.estimate} {}

  /// Distance at which |τ| first is `factor`; none as Profile::interval().
  std::optional<double> end() {
    double step = half_;
    for (int refit = 0; refit < most_refits && within_.step < longest * half_; ++refit) {
      Place place = at(step);
      if (monitor_.should_stop()) return std::nullopt;
      if (std::abs(place.tau - factor_) < near_enough * factor_) return step;
      const bool inside = place.tau < factor_;
      same_side_ = inside == last_inside_ ? same_side_ + 1 : 0;
      last_inside_ = inside;
      if (inside) within_ = std::move(place);
      else beyond_ = std::move(place);
      if (beyond_ && beyond_->step - within_.step < near_enough * beyond_->step) return within_.step;
      step = next();
    }
    if (beyond_ && within_.step == 0) return std::nullopt;
    return beyond_ ? within_.step : no_end;
  }

 private:
  struct Place {
    double step, tau;
    Eigen::VectorXd x;
  };

  /// From the last place within where the first start leads nowhere.
  Place at(double step) {
    Place place{step, no_end, start_at(step)};
    std::optional<double> tau = state_.refit(column_, place.x, monitor_);
    if (!tau && !monitor_.should_stop()) {
      place.x = within_.x;
      place.x[column_] = state_.estimate[column_] + sign_ * step;
      tau = state_.refit(column_, place.x, monitor_);
    }
    place.tau = tau.value_or(no_end);
    return place;
  }

  /// By what is known on both sides of it, or else from the estimate to the last place within, or by the linear
  /// problem.
  Eigen::VectorXd start_at(double step) const {
    Eigen::VectorXd x;
    if (beyond_ && std::isfinite(beyond_->tau))
      x = within_.x + (beyond_->x - within_.x) * ((step - within_.step) / (beyond_->step - within_.step));
    else if (within_.step > 0) x = state_.estimate + (within_.x - state_.estimate) * (step / within_.step);
    else x = state_.along(column_, sign_ * step);
    x[column_] = state_.estimate[column_] + sign_ * step;
    return x;
  }

  double next() const {
    if (!beyond_) {
      const double wanted = within_.step * (1 + aim * (factor_ / std::max(within_.tau, 1e-12) - 1));
      return std::clamp(wanted, shortest_step * within_.step, longest_step * within_.step);
    }
    const double length = beyond_->step - within_.step;
    if (!std::isfinite(beyond_->tau) || same_side_ > 1) return within_.step + length / 2;
    const double part = (factor_ - within_.tau) / (beyond_->tau - within_.tau);
    return within_.step + length * std::clamp(part, margin, 1 - margin);
  }

  State& state_;
  int column_;
  double sign_, factor_, half_;
  const Monitor& monitor_;
  Place within_;
  std::optional<Place> beyond_;
  bool last_inside_ = true;
  int same_side_ = 0;
};

Profile::Profile(const IdentificationModel& model, const VariantColumns& columns,
                 const std::vector<MeasuredPose>& poses, const FitOptions& options, const Fit& fit)
    : state_(std::make_unique<State>(model, columns, poses, options, fit)) {}
Profile::~Profile() = default;

std::optional<double> Profile::tau(int column, double value, const Monitor& monitor) {
  const double change = value / state_->tolerance(column) - state_->estimate[column];
  const std::optional<double> tau = state_->farther(column, change, monitor);
  return tau ? std::optional(std::copysign(*tau, change)) : std::nullopt;
}

std::optional<ProfileInterval> Profile::interval(int column, double factor, const Monitor& monitor) {
  const std::optional<double> below = Side(*state_, column, -1, factor, monitor).end();
  const std::optional<double> above = below ? Side(*state_, column, 1, factor, monitor).end() : std::nullopt;
  if (!above) return std::nullopt;
  const double unit = state_->tolerance(column), at = state_->estimate[column];
  return ProfileInterval{unit * (at - *below), unit * (at + *above)};
}

double Profile::better() const { return state_->better; }
const std::vector<double>& Profile::better_estimate() const { return state_->better_estimate; }

Profiles profile_intervals(const IdentificationModel& model, const VariantColumns& columns,
                           const std::vector<MeasuredPose>& poses, const FitOptions& options, const Fit& fit,
                           const std::vector<int>& wanted, double factor, int threads, const Monitor& monitor) {
  Profiles result;
  result.intervals.resize(wanted.size());
  const int workers = std::min(thread_count(threads), int(wanted.size()));
  std::vector<std::unique_ptr<Profile>> profiles;
  profiles.reserve(std::size_t(workers));
  for (int worker = 0; worker < workers; ++worker)
    profiles.push_back(std::make_unique<Profile>(model, columns, poses, options, fit));
  std::atomic<int> done{0};
  parallel_for(wanted.size(), workers, [&](std::size_t i, int worker) {
    if (monitor.should_stop()) return;
    result.intervals[i] = profiles[std::size_t(worker)]->interval(wanted[i], factor, monitor);
    monitor.report({"profiles", double(++done), double(wanted.size()), {}, {}, {}});
  });
  for (const auto& profile : profiles)
    if (profile->better() > result.better) {
      result.better = profile->better();
      result.better_estimate = profile->better_estimate();
    }
  return result;
}

}  // namespace posewright
