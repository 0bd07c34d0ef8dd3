#include "variant_alias.hpp"

#include <algorithm>
#include <cmath>

#include "fitted_bias.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/effects.hpp"

namespace posewright {
namespace {

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

}  // namespace posewright
