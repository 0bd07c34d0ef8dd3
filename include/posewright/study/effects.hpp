#pragma once

#include "posewright/blocks/parameter.hpp"
#include "posewright/planning/alias.hpp"
#include "posewright/results/comparison.hpp"
#include "posewright/study/study.hpp"

namespace posewright {

/// Effects of a truth on the readings that a fitted variant does not estimate (docs/compare.md): the only definition of
/// effects by nominal and by tolerance.
struct Effects {
  std::vector<AliasSource> sources;
  VariantColumns columns;  ///< those that are fitted, then those that sources need
  int fitted = 0;
  /// columns × effects: by nominal all sources together (one effect, if there are any), by tolerance each for itself.
  Eigen::MatrixXd combinations;
  bool by_nominal = false;  ///< whether the first effect is that of the nominal values

  Eigen::Index count() const { return combinations.cols(); }
};

/// @param truth  names its parameters; only its nominal values and `selected` columns count
/// @param prior  tolerances of fitted parameters act as prior knowledge
Effects effects_of(const Variant& fitted, const IdentificationModel& truth, const VariantColumns& selected, bool prior);

/// Estimates by least squares on these poses for every effect, linearised at the nominal values of `fitted`.
struct EffectFit {
  Eigen::MatrixXd taken;     ///< fitted × effects: bias of the estimates
  Eigen::VectorXd unfitted;  ///< squared length of each effect's residual, whitened
  Eigen::MatrixXd errors;    ///< fitted × effects: estimate less truth
};
EffectFit fit_effects(const Effects& effects, const Variant& fitted, const Configurations& poses, const Setup& setup);

/// Error at a test pose by every effect: estimate less truth.
/// @param point  of all columns of the effects
Eigen::MatrixXd errors_at(const TestPoint& point, const Effects& effects, const EffectFit& fit);

/// True if the parameters mean the same in both.
bool one_catalogue(const IdentificationModel& a, const IdentificationModel& b);

/// The test of the residuals at 5 %, from the residual of every effect.
Discrimination discrimination_of(const std::string& truth, const Effects& effects, const Eigen::VectorXd& unfitted,
                                 const Variant& fitted, const Configurations& poses, bool prior);

}  // namespace posewright
