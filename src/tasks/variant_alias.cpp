#include "variant_alias.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "posewright/calibration/fit.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/effects.hpp"
#include "posewright/support/error.hpp"
#include "virtual_truth.hpp"

namespace posewright {
namespace {

/// Estimate less truth of every column of `fitted`, SI, where readings without noise come from `truth` at its nominal
/// values: the whole nonlinear fit, actuators standing alike. Empty if the fit does not arrive.
std::optional<Eigen::VectorXd> fitted_bias(const Variant& fitted, const Variant& truth, const Configurations& poses,
                                           bool prior) {
  std::vector<std::vector<double>> at;
  for (std::size_t i = 0; i < poses.count(); ++i) at.emplace_back(poses[i].begin(), poses[i].end());
  try {
    const std::vector<std::vector<double>> stands = same_actuators(*fitted.model, *truth.model, at);
    std::vector<MeasuredPose> measured;
    for (std::size_t i = 0; i < at.size(); ++i) {
      MeasuredPose pose{int(i) + 1, at[i], {}};
      if (!truth.model->predict(stands[i], {}, pose.y)) return std::nullopt;
      fitted.model->blank_hidden(pose.q, pose.y);
      measured.push_back(std::move(pose));
    }
    FitOptions options;
    options.prior = prior ? Prior::every : Prior::none;
    const Fit result = fit(*fitted.model, fitted.columns, measured, options);
    if (!result.converged) return std::nullopt;
    Eigen::VectorXd bias = result.change;
    for (std::size_t j = 0; j < fitted.columns.selected.size(); ++j) {
      const auto i = std::size_t(fitted.columns.selected[j]);
      bias[Eigen::Index(j)] -= truth.model->parameters()[i].nominal - fitted.model->parameters()[i].nominal;
    }
    return bias;
  } catch (const CannotDo&) {
    return std::nullopt;
  }
}

/// Error of the calibrated robot at the test poses.
void add_test_poses(VariantAlias& alias, const Variant& fitted, const Effects& effects, const EffectFit& fit,
                    const Evaluation& evaluation, std::uint64_t seed) {
  if (fitted.test_points.empty()) return;
  std::vector<double> each;
  alias.rho0 = predicted_error(fitted.test_points, evaluation.covariance, each);
  double shift = 0, spread = 0, total = 0;
  const Eigen::Index shifts = effects.by_nominal ? 1 : 0, spreads = effects.count() - shifts;
  for (const TestPoint& point : test_points_of(fitted, effects.columns, seed)) {
    const Eigen::MatrixXd error = errors_at(point, effects, fit);
    shift += point.weight * error.leftCols(shifts).squaredNorm();
    spread += point.weight * error.rightCols(spreads).squaredNorm();
    total += point.weight;
  }
  alias.rho0_shift = std::sqrt(shift / total);
  alias.rho0_spread = std::sqrt(spread / total);
}

/// Root mean square over the parameters of interest that both estimate, in units of the tolerances of `with`.
void compare_shared(ExtraWorth& worth, const JudgedVariant& with, const JudgedVariant& without,
                    const VariantAlias& alias) {
  const VariantColumns &more = with.variant->columns, &fewer = without.variant->columns;
  double error = 0, noise = 0, bias = 0;
  int shared = 0;
  for (std::size_t j = 0; j < fewer.selected.size(); ++j)
    for (std::size_t k = 0; k < more.selected.size(); ++k) {
      const Parameter& label = more.parameters[k];
      if (fewer.selected[j] != more.selected[k] || label.role != Role::interest ||
          fewer.parameters[j].role != Role::interest)
        continue;
      const AliasedParameter& aliased = alias.parameters[j];
      error += std::pow(with.evaluation->sigma[Eigen::Index(k)] / label.tolerance, 2);
      noise += std::pow(aliased.sigma / label.tolerance, 2);
      bias += (std::pow(aliased.shift, 2) + std::pow(aliased.spread, 2)) / std::pow(label.tolerance, 2);
      ++shared;
    }
  if (shared == 0) {
    worth.why_not = "they share no parameter of interest; design: test_poses would decide it";
    return;
  }
  worth.error_with = std::sqrt(error / shared);
  worth.noise_without = std::sqrt(noise / shared);
  worth.bias_without = std::sqrt(bias / shared);
}

}  // namespace

std::vector<int> extra_columns(const Variant& with, const Variant& without) {
  std::vector<int> extra;
  const std::vector<int>&all = with.columns.selected, &known = without.columns.selected;
  for (std::size_t j = 0; j < all.size(); ++j)
    if (std::find(known.begin(), known.end(), all[j]) == known.end()) extra.push_back(int(j));
  return extra;
}

VariantAlias variant_alias(const Setup& setup, const Variant& fitted, const Variant& truth, const Configurations& poses,
                           const Evaluation& evaluation) {
  VariantAlias alias;
  alias.fitted = fitted.spec->name;
  alias.truth = truth.spec->name;
  if (!one_catalogue(*fitted.model, *truth.model)) {
    alias.why_not = "the variants use different kinds of parameters";
    return alias;
  }
  const Effects effects = effects_of(fitted, *truth.model, truth.columns, setup.prior);
  alias.sources = effects.sources;
  const EffectFit fit = fit_effects(effects, fitted, poses, setup);
  const VariantColumns& columns = fitted.columns;
  const Eigen::Index shifts = effects.by_nominal ? 1 : 0, spreads = effects.count() - shifts;
  const Eigen::VectorXd shift = fit.errors.leftCols(shifts).rowwise().sum();
  const Eigen::VectorXd spread = fit.errors.rightCols(spreads).rowwise().norm();
  std::optional<Eigen::VectorXd> whole;
  if (effects.by_nominal) whole = fitted_bias(fitted, truth, poses, setup.prior);
  for (std::size_t j = 0; j < columns.parameters.size(); ++j) {
    const auto k = Eigen::Index(j);
    alias.parameters.push_back({columns.parameters[j], evaluation.sigma[k], shift[k], spread[k]});
    if (whole) alias.parameters.back().fitted = (*whole)[k];
  }
  add_test_poses(alias, fitted, effects, fit, evaluation, setup.planner.seed);
  if (effects.count() > 0)
    alias.test = discrimination_of(alias.truth, effects, fit.unfitted, fitted, poses, setup.prior);
  return alias;
}

ExtraWorth extra_worth(const JudgedVariant& with, const JudgedVariant& without, const VariantAlias& alias) {
  ExtraWorth worth;
  worth.with = with.variant->spec->name;
  worth.without = without.variant->spec->name;
  worth.plan_with = with.plan;
  worth.plan_without = without.plan;
  worth.why_not = alias.why_not;
  const bool places = !with.variant->test_points.empty();
  worth.measure = places ? ExtraWorth::Measure::test_poses : ExtraWorth::Measure::shared_parameters;
  if (alias.why_not.empty())
    for (const int k : extra_columns(*with.variant, *without.variant))
      worth.extra.push_back(with.variant->columns.parameters[std::size_t(k)].name);
  if (places) {
    std::vector<double> each;
    worth.error_with = predicted_error(with.variant->test_points, with.evaluation->covariance, each);
    worth.noise_without = predicted_error(without.variant->test_points, without.evaluation->covariance, each);
    if (alias.why_not.empty()) worth.bias_without = std::hypot(alias.rho0_shift, alias.rho0_spread);
  } else if (alias.why_not.empty()) {
    compare_shared(worth, with, without, alias);
  }
  return worth;
}

}  // namespace posewright
