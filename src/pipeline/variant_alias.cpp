#include "variant_alias.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "posewright/planning/alias.hpp"
#include "posewright/support/error.hpp"
#include "test_points.hpp"

namespace posewright {
namespace {

/// Columns of the fitted variant, then those of effects that it does not fit.
struct Effects {
  VariantColumns columns;  ///< all that count, each once
  std::vector<int> at;     ///< of each source: its index into columns
  Eigen::VectorXd shift, spread;
};

Effects effects_of(const PreparedVariant& fitted, const PreparedVariant& truth, bool prior,
                   std::vector<AliasSource>& sources) {
  Effects effects;
  effects.columns = fitted.columns();
  std::vector<double> shifts, spreads;
  const std::vector<int> extra = extra_columns(truth, fitted);
  const std::vector<int>&selected = truth.columns().selected, &own = fitted.columns().selected;
  for (int i = 0; i < int(fitted.model->parameters().size()); ++i) {
    Parameter label = truth.model->parameters()[std::size_t(i)];
    const double shift = label.nominal - fitted.model->parameters()[std::size_t(i)].nominal;
    const auto known = std::find(own.begin(), own.end(), i);
    const auto more = std::find_if(extra.begin(), extra.end(), [&](int k) { return selected[std::size_t(k)] == i; });
    if (more != extra.end()) label = truth.columns().parameters[std::size_t(*more)];
    if (known != own.end()) label = fitted.columns().parameters[std::size_t(known - own.begin())];
    const double spread = more != extra.end() && shift == 0 ? label.tolerance : 0.0;
    // What is fitted comes out right, unless knowledge from before holds it to the nominal value.
    if ((shift == 0 && spread == 0) || (known != own.end() && !prior)) continue;
    sources.push_back({label, shift, spread});
    shifts.push_back(shift);
    spreads.push_back(spread);
    if (known != own.end()) {
      effects.at.push_back(int(known - own.begin()));
      continue;
    }
    effects.at.push_back(int(effects.columns.selected.size()));
    effects.columns.selected.push_back(i);
    effects.columns.parameters.push_back(label);
    effects.columns.tiers.push_back(0);
  }
  effects.shift = Eigen::Map<Eigen::VectorXd>(shifts.data(), Eigen::Index(shifts.size()));
  effects.spread = Eigen::Map<Eigen::VectorXd>(spreads.data(), Eigen::Index(spreads.size()));
  return effects;
}

/// Fitted columns, then those of the effects.
BlockArray arranged(const BlockArray& blocks, int own, const std::vector<int>& at) {
  BlockArray result(blocks.count(), blocks.rows(), own + int(at.size()));
  result.all().leftCols(own) = blocks.all().leftCols(own);
  for (std::size_t k = 0; k < at.size(); ++k) result.all().col(own + Eigen::Index(k)) = blocks.all().col(at[k]);
  return result;
}

/// Error of the estimates, own × sources: what they take up less what they should.
Eigen::MatrixXd errors_per_unit(const Effects& effects, const PreparedVariant& fitted, const Configurations& poses,
                                const Settings& settings) {
  const int own = int(fitted.columns().selected.size());
  // One array for both, so that rows are whitened and factored alike.
  const BlockArray blocks = build_blocks(*fitted.model, effects.columns.selected, poses, settings.planner.threads);
  Eigen::VectorXd known;
  if (settings.prior) {
    known.resize(own);
    for (int j = 0; j < own; ++j) known[j] = fitted.columns().parameters[std::size_t(j)].tolerance;
  }
  Eigen::MatrixXd taken = alias_matrix(arranged(blocks, own, effects.at), own, known);
  for (std::size_t k = 0; k < effects.at.size(); ++k)
    if (effects.at[k] < own) taken(effects.at[k], Eigen::Index(k)) -= 1.0;
  return taken;
}

/// Error of the calibrated robot at the test poses: what the estimates say less what is there.
void add_test_poses(VariantAlias& alias, const Problem& problem, const PreparedVariant& fitted, const Effects& effects,
                    const Eigen::MatrixXd& errors, const Evaluation& evaluation, const Settings& settings) {
  if (fitted.test_points.empty()) return;
  std::vector<double> each;
  alias.rho0 = predicted_error(fitted.test_points, evaluation.covariance, each);
  double shift = 0, spread = 0, total = 0;
  const Eigen::Index own = errors.rows();
  for (const TestPoint& point :
       test_points_of(problem, *fitted.spec, *fitted.model, effects.columns, settings.planner.seed)) {
    Eigen::MatrixXd error = point.A.leftCols(own) * errors;
    for (std::size_t k = 0; k < effects.at.size(); ++k)
      if (effects.at[k] >= own) error.col(Eigen::Index(k)) -= point.A.col(effects.at[k]);
    shift += point.weight * (error * effects.shift).squaredNorm();
    spread += point.weight * (error * effects.spread.asDiagonal()).squaredNorm();
    total += point.weight;
  }
  alias.rho0_shift = std::sqrt(shift / total);
  alias.rho0_spread = std::sqrt(spread / total);
}

}  // namespace

bool one_catalogue(const IdentificationModel& a, const IdentificationModel& b) {
  const auto &x = a.parameters(), &y = b.parameters();
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const Parameter& p, const Parameter& q) { return p.name == q.name && p.unit == q.unit; });
}

std::vector<int> extra_columns(const PreparedVariant& with, const PreparedVariant& without) {
  std::vector<int> extra;
  const std::vector<int>&all = with.columns().selected, &known = without.columns().selected;
  for (std::size_t j = 0; j < all.size(); ++j)
    if (std::find(known.begin(), known.end(), all[j]) == known.end()) extra.push_back(int(j));
  return extra;
}

VariantAlias variant_alias(const Problem& problem, const PreparedVariant& fitted, const PreparedVariant& truth,
                           const Configurations& poses, const Evaluation& evaluation, const Settings& settings) {
  VariantAlias alias;
  alias.fitted = fitted.spec->name;
  alias.truth = truth.spec->name;
  if (!one_catalogue(*fitted.model, *truth.model)) {
    alias.why_not = "the variants do not share one catalogue of parameters";
    return alias;
  }
  const Effects effects = effects_of(fitted, truth, settings.prior, alias.sources);
  const VariantColumns& columns = fitted.columns();
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(Eigen::Index(columns.selected.size()), effects.shift.size());
  if (!alias.sources.empty()) errors = errors_per_unit(effects, fitted, poses, settings);
  const Eigen::VectorXd shift = errors * effects.shift;
  const Eigen::VectorXd spread = (errors * effects.spread.asDiagonal()).rowwise().norm();
  for (std::size_t j = 0; j < columns.parameters.size(); ++j) {
    const auto k = Eigen::Index(j);
    alias.parameters.push_back({columns.parameters[j], evaluation.sigma[k], shift[k], spread[k]});
  }
  add_test_poses(alias, problem, fitted, effects, errors, evaluation, settings);
  return alias;
}

}  // namespace posewright
