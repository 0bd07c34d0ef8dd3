#include "posewright/pipeline/calibrate_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/calibration/placement.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/pipeline/measured_data.hpp"
#include "posewright/support/distributions.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Shares of a column's norm below this are rounding: the dependency is exact.
constexpr double exact_dependency = 1e-9;
// A model that chance refuses this seldom is refused: its σ are stretched to the residuals.
constexpr double refusal = 0.01;
// Residuals so many times the noise are no robot's.
constexpr double absurd = 1000.0;
// With a prior, σ is below the tolerance anyhow: here data and prior tell as much as each other.
constexpr double prior_share = 1 / std::numbers::sqrt2;

class CalibrationRun {
 public:
  CalibrationRun(Problem problem, const CalibrateOptions& options, const Monitor& monitor)
      : problem_(std::move(problem)),
        options_(options),
        monitor_(monitor),
        spec_(find_variant(problem_, options.variant)),
        model_(make_model(problem_, spec_)) {
    result_.variant = spec_.name;
    result_.weighting = options.weighting;
    result_.prior = options.prior || problem_.design.prior;
    read();
  }

  Calibration run() {
    report(0);
    FitOptions fit_options;
    fit_options.weighting = options_.weighting;
    fit_options.prior = result_.prior;
    const VariantColumns all = select_columns(*model_, problem_, spec_);
    placed_ = fit_options.start = placed(*model_, all, fitted_, fit_options);
    choose_columns(all);
    result_.fit = fit(*model_, columns_, fitted_, fit_options);
    report(1);
    result_.correction = result_.fit.correction;
    if (!result_.fit.converged)
      result_.notes.push_back("the estimate did not converge: are nominal base, tool and units right?");
    result_.tests = test_residuals(result_.fit);
    judge_noise();
    result_.curvature = curvature(*model_, columns_, fitted_, result_.fit);
    result_.curvature.largest *= result_.sigma_factor;
    fill_parameters();
    fill_residuals();
    report(2);
    return std::move(result_);
  }

 private:
  void read() {
    MeasuredData data = read_measured_data(options_.data, problem_, *model_);
    result_.notes = data.notes;
    result_.rows = data.rows;
    result_.repeats = data.repeats;
    result_.spread = data.spread;
    result_.readings = model_->readings();
    spread_freedom_ = data.spread_freedom;
    if (data.rows > int(data.poses.size())) use_repeats(data.repeats);
    for (std::size_t k = 0; k < data.poses.size(); ++k) {
      const bool back = data.held_back[k] || (options_.hold_back > 0 && (k + 1) % std::size_t(options_.hold_back) == 0);
      (back ? held_back_ : fitted_).push_back(std::move(data.poses[k]));
    }
    if (!options_.validate.empty()) {
      MeasuredData more = read_measured_data(options_.validate, problem_, *model_);
      for (const std::string& note : more.notes) result_.notes.push_back(options_.validate.string() + ": " + note);
      for (MeasuredPose& pose : more.poses) held_back_.push_back(std::move(pose));
    }
    if (fitted_.empty()) throw InputError({options_.data.string(), 0}, "has no pose to fit", "use: fit");
    result_.poses = int(fitted_.size());
    result_.held_back = int(held_back_.size());
  }

  /// Rows that were averaged are the repeats, whatever the problem planned.
  void use_repeats(double repeats) {
    const int rounded = std::max(1, int(std::lround(repeats)));
    if (std::abs(repeats - rounded) > 1e-9)
      result_.notes.push_back(
          fmt::format("poses have different numbers of readings; each counts as the mean of {} (harmonic mean {:.3g})",
                      rounded, repeats));
    if (rounded == problem_.measurement.repeats) return;
    result_.notes.push_back(fmt::format("{} readings a pose are averaged, not {} as the problem says", rounded,
                                        problem_.measurement.repeats));
    problem_.measurement.repeats = rounded;
    model_ = make_model(problem_, spec_);
  }

  void report(double done) const { monitor_.report({"calibration", done, 2, {}, {}, {}}); }

  /// Columns that these poses determine, judged where things stand: at the origin of the flange a target would say
  /// nothing of the wrist.
  void choose_columns(const VariantColumns& all) {
    if (result_.prior && !all.automatic) {
      columns_ = all;
      return;
    }
    IdentifiabilityOptions options;
    if (!all.automatic) options.threshold = exact_dependency;
    options.tiers = all.tiers;
    const Identifiability found = identifiability(blocks_of(*model_, all, fitted_, placed_), all.parameters, options);
    columns_ = subset(all, found.kept);
    result_.automatic = all.automatic;
    for (const Dependency& d : found.dependencies) {
      CalibratedParameter left;
      left.label = all.parameters[std::size_t(d.dropped)];
      left.estimated = false;
      left.value = left.lower = left.upper = left.label.nominal;
      left.why_not = describe(d, all.parameters);
      left_out_.push_back(std::move(left));
    }
    if (columns_.selected.empty()) throw CannotDo("the data determine no parameter of variant '" + spec_.name + "'");
  }

  /// Whether residuals are larger than the noise allows; then σ follow the residuals.
  void judge_noise() {
    const Fit& fit = result_.fit;
    // Prior terms and weights have no place in the comparison with the spread of readings.
    if (fit.freedom > 0 && spread_freedom_ > 0 && !result_.prior && fit.weights.empty()) lack_of_fit();
    if (fit.scale > absurd)
      result_.notes.push_back(fmt::format(
          "residuals are {:.3g} times the stated noise: no robot's errors explain that. Are units, signs of the "
          "joints and the order of the targets right?",
          fit.scale));
    if (!fit.scale_known || fit.freedom < 1) return;
    // Tolerances do not grow with the noise, so with a prior nothing is stretched.
    if (!result_.prior && fit.scale > 1 && chi_square_exceeded(fit.chi_square, fit.freedom) < refusal)
      result_.sigma_factor = fit.scale;
  }

  /// Residuals of the means against the spread of the rows, both in σ of the rows: F of (freedom, rows − poses).
  void lack_of_fit() {
    double between = 0;
    int count = 0;
    for (const Eigen::VectorXd& pose : result_.fit.residuals)
      for (Eigen::Index i = 0; i < pose.size(); ++i) {
        const double spread = result_.spread[std::size_t(i)];
        if (!std::isfinite(pose[i]) || !(spread > 0)) continue;
        between += result_.repeats * (pose[i] / spread) * (pose[i] / spread);
        ++count;
      }
    const int freedom = result_.fit.freedom;
    if (count < result_.fit.readings || freedom < 1) return;
    result_.lack_of_fit.statistic = between / freedom;
    result_.lack_of_fit.probability = fisher_exceeded(result_.lack_of_fit.statistic, freedom, double(spread_freedom_));
    result_.lack_of_fit.possible = true;
  }

  void fill_parameters() {
    const double stretch = interval_factor(interval_probability, result_.fit.scale_known, result_.fit.freedom);
    std::vector<CalibratedParameter> nuisance;
    for (std::size_t j = 0; j < columns_.parameters.size(); ++j) {
      const auto k = Eigen::Index(j);
      CalibratedParameter p;
      p.label = columns_.parameters[j];
      p.value = p.label.nominal + result_.fit.change[k];
      p.sigma = result_.sigma_factor * std::sqrt(result_.fit.covariance(k, k));
      p.lower = p.value - stretch * p.sigma;
      p.upper = p.value + stretch * p.sigma;
      p.weak = p.sigma > p.label.tolerance * (result_.prior ? prior_share : 1.0);
      (p.label.role == Role::nuisance ? nuisance : result_.parameters).push_back(std::move(p));
    }
    for (CalibratedValue& value : calibrated_values(problem_, spec_, *model_, result_.correction))
      result_.values.push_back({std::move(value), {}});
    for (std::size_t j = 0; j < columns_.selected.size(); ++j)
      result_.values[std::size_t(columns_.selected[j])].sigma =
          result_.sigma_factor * std::sqrt(result_.fit.covariance(Eigen::Index(j), Eigen::Index(j)));
    for (const Parameter& p : columns_.parameters) result_.columns.push_back(p.name);
    for (auto* more : {&nuisance, &left_out_})
      result_.parameters.insert(result_.parameters.end(), more->begin(), more->end());
  }

  void add_set(const char* which, const char* parameters, const std::vector<MeasuredPose>& poses,
               const std::vector<double>& correction) {
    if (poses.empty()) return;
    result_.residuals.push_back(
        {which, parameters, summarise(*model_, poses, residuals_of(*model_, correction, poses))});
  }

  void fill_residuals() {
    const std::vector<double> nominal(model_->parameters().size(), 0.0);
    const std::size_t placing = placing_columns(*model_, columns_).selected.size();
    for (const auto& [which, poses] : {std::pair{"fitted", &fitted_}, std::pair{"held back", &held_back_}}) {
      add_set(which, "nominal", *poses, nominal);
      if (placing > 0 && placing < columns_.selected.size()) add_set(which, "placed", *poses, placed_);
      add_set(which, "calibrated", *poses, result_.correction);
    }
    for (std::size_t k = 0; k < fitted_.size(); ++k) {
      double weight = 1;
      if (!result_.fit.weights.empty())
        for (const double w : result_.fit.weights[k]) weight = std::min(weight, w);
      const Eigen::VectorXd& r = result_.fit.residuals[k];
      result_.pose_residuals.push_back({fitted_[k].id, false, {r.begin(), r.end()}, weight});
    }
    const auto beyond = residuals_of(*model_, result_.correction, held_back_);
    for (std::size_t k = 0; k < held_back_.size(); ++k)
      result_.pose_residuals.push_back({held_back_[k].id, true, {beyond[k].begin(), beyond[k].end()}, 1.0});
  }

  Problem problem_;
  const CalibrateOptions& options_;
  const Monitor& monitor_;
  const VariantSpec& spec_;
  std::unique_ptr<IdentificationModel> model_;
  VariantColumns columns_;
  std::vector<MeasuredPose> fitted_, held_back_;
  std::vector<CalibratedParameter> left_out_;
  std::vector<double> placed_;
  int spread_freedom_ = 0;
  Calibration result_;
};

}  // namespace

Calibration calibrate_problem(const Problem& problem, const CalibrateOptions& options, const Monitor& monitor) {
  return CalibrationRun(problem, options, monitor).run();
}

}  // namespace posewright
