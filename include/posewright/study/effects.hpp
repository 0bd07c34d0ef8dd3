#pragma once

#include "posewright/blocks/parameter.hpp"
#include "posewright/outputs/plan.hpp"
#include "posewright/planning/alias.hpp"
#include "posewright/study/study.hpp"

namespace posewright {

/// An effect that the truth has and the fitted variant does not.
struct AliasSource {
  Parameter label;
  double shift = 0.0;   ///< nominal of the truth − nominal of the fitted
  double spread = 0.0;  ///< its tolerance where the truth estimates it, the fitted does not, and the nominals are equal
};

/// What a truth does to the readings and a fitted variant does not estimate (docs/compare.md): the one definition of
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
/// @param prior  what is fitted is held to its nominal value by its tolerance
Effects effects_of(const Variant& fitted, const IdentificationModel& truth, const VariantColumns& selected, bool prior);

/// What least squares on these poses makes of every effect, linearised at the nominal values of `fitted`.
struct EffectFit {
  Eigen::MatrixXd taken;     ///< fitted × effects: what the estimates take up
  Eigen::VectorXd unfitted;  ///< squared length of what is left of each effect, whitened
  Eigen::MatrixXd errors;    ///< fitted × effects: estimate less truth
};
EffectFit fit_effects(const Effects& effects, const Variant& fitted, const Configurations& poses,
                      const Settings& settings);

/// Error at a test pose by every effect: what the estimates say less what is there.
/// @param point  of all columns of the effects
Eigen::MatrixXd errors_at(const TestPoint& point, const Effects& effects, const EffectFit& fit);

/// Whether the parameters mean the same in both.
bool one_catalogue(const IdentificationModel& a, const IdentificationModel& b);

/// The test of the residuals at 5 %, from what is left of every effect.
Discrimination discrimination_of(const std::string& truth, const Effects& effects, const Eigen::VectorXd& unfitted,
                                 const Variant& fitted, const Configurations& poses, bool prior);

}  // namespace posewright
