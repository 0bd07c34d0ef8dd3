#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Parameters that were not fitted and that one effect consists of.
struct EffectToTest {
  std::string name;
  std::vector<int> parameters;  ///< of the model's catalogue
};

/// Score test of an unfitted effect by the residuals of a fit.
struct ScoreTest {
  std::string name;
  double gain = 0.0;         ///< by how much fitting it too would lower the sum of squared whitened residuals
  double share = 0.0;        ///< the same as a share of that sum
  int freedom = 0;           ///< of the effect: parameters that the fitted ones do not imitate
  double statistic = 0.0;    ///< F
  double probability = 1.0;  ///< that chance alone gives as much
  double corrected = 1.0;    ///< the same for the best of as many tests (Bonferroni)
  Eigen::VectorXd moves;     ///< of the fitted columns, SI: how far they would move if the effect were fitted, too

  bool beyond_chance() const { return corrected < 0.01; }
  /// Most of what is left is this effect, and chance does not give it.
  bool dominates() const { return beyond_chance() && share > 0.5; }
};

/// Score tests (Rao 1948) of effects beside a fit, one by one, on its linearisation: with r the whitened residuals and
/// X the effect's columns less their part in the fitted ones, gain = ‖X(XᵀX)⁻¹Xᵀr‖² and F = (gain/k)/((‖r‖² − gain)/(ν
/// − k)) of k and ν − k degrees of freedom, ν = readings − fitted parameters: right for noise of any size. Best first;
/// effects of which the fitted parameters leave nothing, and those for which no degree of freedom is left, are not
/// listed.
/// @param columns  fitted columns of `model`
/// @param correction  of all parameters of `model`
std::vector<ScoreTest> score_tests(const IdentificationModel& model, const VariantColumns& columns,
                                   const std::vector<MeasuredPose>& poses, const std::vector<double>& correction,
                                   const Fit& fit, const std::vector<EffectToTest>& effects);

}  // namespace posewright
