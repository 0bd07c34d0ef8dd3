#include "posewright/study/effects.hpp"

#include <algorithm>

#include "posewright/planning/power.hpp"

namespace posewright {
namespace {

/// Index of a catalogue's parameter in a list of columns; −1: none.
int place_of(int parameter, const std::vector<int>& columns) {
  const auto found = std::find(columns.begin(), columns.end(), parameter);
  return found == columns.end() ? -1 : int(found - columns.begin());
}

/// Index into the columns of what an effect needs; put behind the fitted ones if it is not among them.
int column_for(Effects& effects, int parameter, const Parameter& label) {
  if (const int known = place_of(parameter, effects.columns.selected); known >= 0) return known;
  effects.columns.selected.push_back(parameter);
  effects.columns.parameters.push_back(label);
  effects.columns.tiers.push_back(0);
  return int(effects.columns.selected.size()) - 1;
}

void combine(Effects& effects, const std::vector<int>& at) {
  const auto sources = Eigen::Index(effects.sources.size());
  const auto is_shift = [](const AliasSource& s) { return s.shift != 0; };
  const auto shifts = std::count_if(effects.sources.begin(), effects.sources.end(), is_shift);
  effects.by_nominal = shifts > 0;
  effects.combinations =
      Eigen::MatrixXd::Zero(Eigen::Index(effects.columns.selected.size()), sources - shifts + (shifts > 0 ? 1 : 0));
  Eigen::Index next = shifts > 0 ? 1 : 0;
  for (std::size_t k = 0; k < effects.sources.size(); ++k) {
    const AliasSource& source = effects.sources[k];
    if (source.shift != 0) effects.combinations(at[k], 0) = source.shift;
    else effects.combinations(at[k], next++) = source.spread;
  }
}

}  // namespace

Effects effects_of(const Variant& fitted, const IdentificationModel& truth, const VariantColumns& selected,
                   bool prior) {
  Effects effects;
  effects.columns = fitted.columns;
  effects.fitted = int(effects.columns.selected.size());
  const std::vector<int> own = effects.columns.selected;
  std::vector<int> at;
  for (int i = 0; i < int(fitted.model->parameters().size()); ++i) {
    Parameter label = truth.parameters()[std::size_t(i)];
    const double shift = label.nominal - fitted.model->parameters()[std::size_t(i)].nominal;
    const int known = place_of(i, own), estimated = place_of(i, selected.selected);
    if (estimated >= 0) label = selected.parameters[std::size_t(estimated)];
    if (known >= 0) label = fitted.columns.parameters[std::size_t(known)];
    const double spread = estimated >= 0 && known < 0 && shift == 0 ? label.tolerance : 0.0;
    // What is fitted comes out right, unless knowledge from before holds it to the nominal value.
    if ((shift == 0 && spread == 0) || (known >= 0 && !prior)) continue;
    effects.sources.push_back({label, shift, spread});
    at.push_back(column_for(effects, i, label));
  }
  combine(effects, at);
  return effects;
}

EffectFit fit_effects(const Effects& effects, const Variant& fitted, const Configurations& poses, const Setup& setup) {
  const Eigen::Index own = effects.fitted;
  EffectFit fit;
  if (effects.count() == 0) {
    fit.taken = fit.errors = Eigen::MatrixXd::Zero(own, 0);
    return fit;
  }
  // One array for both, so that rows are whitened and factored alike.
  const BlockArray blocks = build_blocks(*fitted.model, effects.columns.selected, poses, setup.planner.threads);
  BlockArray arranged(blocks.count(), blocks.rows(), int(own + effects.count()));
  arranged.all().leftCols(own) = blocks.all().leftCols(own);
  arranged.all().rightCols(effects.count()) = blocks.all() * effects.combinations;
  Eigen::VectorXd known;
  if (setup.prior) {
    known.resize(own);
    for (Eigen::Index j = 0; j < own; ++j) known[j] = fitted.columns.parameters[std::size_t(j)].tolerance;
  }
  AliasFit found = fit_aliases(arranged, int(own), known);
  fit.taken = std::move(found.taken);
  fit.unfitted = std::move(found.residual);
  fit.errors = fit.taken - effects.combinations.topRows(own);
  return fit;
}

Eigen::MatrixXd errors_at(const TestPoint& point, const Effects& effects, const EffectFit& fit) {
  return point.A.leftCols(effects.fitted) * fit.taken - point.A * effects.combinations;
}

bool one_catalogue(const IdentificationModel& a, const IdentificationModel& b) {
  const auto &x = a.parameters(), &y = b.parameters();
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const Parameter& p, const Parameter& q) { return p.name == q.name && p.unit == q.unit; });
}

Discrimination discrimination_of(const std::string& truth, const Effects& effects, const Eigen::VectorXd& unfitted,
                                 const Variant& fitted, const Configurations& poses, bool prior) {
  Discrimination test;
  test.truth = truth;
  if (effects.by_nominal) test.by_nominal = unfitted[0];
  if (const Eigen::Index spreads = effects.count() - (effects.by_nominal ? 1 : 0); spreads > 0)
    test.by_tolerance = unfitted.tail(spreads).sum();
  // With a prior every estimate has one more reading, that of its tolerance.
  test.readings = prior ? effects.fitted : 0;
  for (std::size_t i = 0; i < poses.count(); ++i) test.readings += fitted.model->visible_rows(poses[i]);
  test.fitted = effects.fitted;
  const double lambda = test.noncentrality();
  if (test.degrees_of_freedom() < 1) return test;
  test.power = chi_square_power(lambda, test.degrees_of_freedom(), test.level);
  // What is known before is not measured again.
  if (!prior) test.repetitions = repetitions_for_power(lambda, test.readings, test.fitted, test.level, test.wanted);
  if (!test.by_nominal || test.by_tolerance) return test;
  test.power_along = chi_square_power(lambda, 1, test.level);
  if (!prior) test.repetitions_along = repetitions_along_effect(lambda, test.level, test.wanted);
  return test;
}

}  // namespace posewright
