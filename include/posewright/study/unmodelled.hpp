#pragma once

#include <optional>
#include <vector>

#include "posewright/planning/evaluate.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/study.hpp"

namespace posewright {

/// Sets up a variant's `unmodelled` for this problem: an effect, and features of it among the candidates
/// for searches. Does nothing for a variant without.
///
/// size auto: as large as what the tolerances of parameters that other variants estimate leave of the tip's position
/// over the candidates beside those that this one does, and at least the noise of one pose's readings as a displacement
/// of the tip. Features: the fewest, up to 32, with which the log det of random sets of candidates is within 1 % of a
/// parameter's share of that with the whole effect, or within 1.5 times what the most of them leave.
/// Throws InputError if the effect is so smooth over the workspace that the estimated parameters take it up, CannotDo
/// if the readings tell of no tip.
void allow_for_unmodelled(const Configurations& candidates, int threads, Variant& variant);

/// Raw whitened blocks of a variant as a search sees them: the effect's features in front, if there is one.
BlockArray search_blocks(const Variant& variant, const Configurations& configurations, int threads);

/// Residuals of columns after least squares on others.
Eigen::MatrixXd left_beside(const Eigen::MatrixXd& others, const Eigen::MatrixXd& columns);

/// Noise of one pose's readings as a displacement of the tip, 1σ along each axis, m: (tr(Σ AᵀA)/3n)^{−1/2}.
/// @param A  whitened derivatives of n poses' readings along unit translations of the tip, 3 columns
double noise_of_a_pose(const Eigen::Ref<const Eigen::MatrixXd>& A, std::size_t n);

/// Default test poses: 200 of the configurations.
std::vector<TestPoint> test_points_at_candidates(const Configurations& candidates, const Variant& variant,
                                                 std::vector<TestPlace>& places);

// Beyond so many poses their own features no longer hold the whole effect: the rest counts as independent.
inline constexpr int whole_features = 150;

/// f of all configurations' tips, one a column.
Eigen::MatrixXd effect_places(const UnmodelledEffect& effect, const Configurations& configurations);
/// Raw whitened blocks of these features, the variant's columns and behind them others of its model.
BlockArray expanded_blocks(const Variant& variant, const EffectFeatures& features, const Configurations& configurations,
                           int threads, const std::vector<int>& others = {});

/// Evaluation of configurations for a variant. With an effect by its whole covariance between them and not by features
/// of candidates: a list says the same whatever was searched.
struct AdjustedEvaluation {
  Evaluation evaluation;
  std::vector<PlaceError> errors;  ///< at every test pose, after compensation by the parameters
  std::optional<PlannedEffect> unmodelled;
};
/// Throws CannotDo as evaluate().
AdjustedEvaluation effect_adjusted_evaluation(const Variant& variant, const Configurations& configurations, Prior prior,
                                              int threads);

}  // namespace posewright
