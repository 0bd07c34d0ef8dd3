#include <cmath>

#include "posewright/model/independent_rows.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

/// Part of the covariance V of the estimates that the tip's displacements at visits have: θ̂ answers what is read at a
/// pose by V J'ᵀ W, primes as below, and at each visit the tip stands off for itself.
Eigen::MatrixXd covariance_by_visits(const Variant& variant, const EffectFeatures& features,
                                     const Configurations& configurations, const Eigen::MatrixXd& F,
                                     const BlockArray& whitened, const Eigen::MatrixXd& V, int threads) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(V.rows(), V.cols());
  const auto visit_at = [&](std::size_t i) -> const Repeatability& {
    return instrument_at(variant.problem->measurement, variant.model->coordinates(), configurations[i]).repeatability;
  };
  bool moved = false;
  for (std::size_t i = 0; i < configurations.count(); ++i)
    moved = moved || visit_at(i).translation > 0 || visit_at(i).rotation > 0;
  if (!moved) return result;
  constexpr int twists = 6;
  std::vector<int> tips;
  for (int tip = 0; tip < variant.model->tips(); ++tip)
    for (int k = 0; k < twists; ++k) tips.push_back(variant.model->tip_column(tip, k));
  const BlockArray blocks = expanded_blocks(variant, features, configurations, threads, tips);
  Eigen::MatrixXd twice = whitened.all();
  IndependentRows(F).apply_transposed(twice);
  const auto rows = Eigen::Index(whitened.rows());
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    Eigen::MatrixXd A = blocks.block(i).rightCols(Eigen::Index(tips.size()));
    const Repeatability& visit = visit_at(i);
    for (Eigen::Index c = 0; c < A.cols(); ++c) A.col(c) *= c % twists < 3 ? visit.translation : visit.rotation;
    const Eigen::MatrixXd answers = V * (twice.middleRows(Eigen::Index(i) * rows, rows).transpose() * A);
    result.noalias() += answers * answers.transpose();
  }
  return result;
}

/// Errors at the test poses of estimates with the covariance V of `worth`, with the effect. With primes for
/// what is whitened by the covariance of all readings: θ̂ − θ = V J'ᵀ(F'u + …), so E[(θ̂ − θ)uᵀ] = V J'ᵀF'; the best u
/// given the readings has the covariance F'ᵀ(I − J'VJ'ᵀ)F' and is independent of θ̂.
void fill_place_errors(const Variant& variant, const EffectFeatures& features, const BlockArray& whitened,
                       const Eigen::MatrixXd& F, const Eigen::MatrixXd& by_visits, AdjustedEvaluation& worth) {
  const Eigen::MatrixXd& V = worth.evaluation.covariance;
  const Eigen::MatrixXd JF = whitened.all().transpose() * F, follows = V * JF;
  const Eigen::MatrixXd told = F.transpose() * F - JF.transpose() * follows;
  const Eigen::MatrixXd by_effect = follows * follows.transpose();
  double total = 0, by_noise = 0, by_effect_there = 0, by_visits_there = 0, interpolated = 0;
  for (std::size_t t = 0; t < variant.test_points.size(); ++t) {
    const TestPoint& point = variant.test_points[t];
    const TestPlace& place = variant.test_places[t];
    const Eigen::VectorXd phi = features.at(variant.effect->place(place.q)).col(0);
    const Eigen::MatrixXd B = features.columns_at(phi, place.twists);
    Eigen::MatrixXd A(6, point.A.cols());
    A << point.A, point.turn;
    Eigen::MatrixXd effect = A * by_effect * A.transpose();
    for (int k = 0; k < variant.effect->twists(); ++k)
      effect += std::pow(variant.effect->size_of(k), 2) * place.twists.col(k) * place.twists.col(k).transpose();
    const Eigen::MatrixXd cross = A * follows * B.transpose();
    effect -= cross + cross.transpose();
    const Eigen::MatrixXd all = A * (V - by_effect) * A.transpose() + effect;
    worth.errors.push_back({all.topLeftCorner<3, 3>(), all.bottomRightCorner<3, 3>()});
    const auto square = [&](const Eigen::MatrixXd& of) { return point.weight * of.topLeftCorner<3, 3>().trace(); };
    by_noise += square(all - effect);
    by_effect_there += square(effect);
    by_visits_there += square(A * by_visits * A.transpose());
    interpolated += square(all - B * told * B.transpose());
    total += point.weight;
  }
  worth.unmodelled->by_noise = std::sqrt(by_noise / total);
  worth.unmodelled->by_repeatability = std::sqrt(by_visits_there / total);
  worth.unmodelled->by_effect = std::sqrt(by_effect_there / total);
  worth.unmodelled->interpolated = std::sqrt(interpolated / total);
}

}  // namespace

AdjustedEvaluation effect_adjusted_evaluation(const Variant& variant, const Configurations& configurations, Prior prior,
                                              int threads) {
  AdjustedEvaluation worth;
  const auto judge = [&](const BlockArray& blocks) {
    worth.evaluation = evaluate(blocks, variant.columns.parameters, prior, variant.scale);
  };
  if (variant.effect == nullptr) {
    judge(build_blocks(*variant.model, variant.columns.selected, configurations, threads));
    worth.errors = place_errors(variant.test_points, worth.evaluation.covariance);
    return worth;
  }
  const EffectFeatures features(variant.effect, effect_places(*variant.effect, configurations), whole_features);
  const BlockArray blocks = expanded_blocks(variant, features, configurations, threads);
  Eigen::MatrixXd F = blocks.all().leftCols(features.columns());
  const Eigen::MatrixXd among_blocks = F;
  const BlockArray whitened = without_features(blocks, features.columns(), &F);
  judge(whitened);
  const UnmodelledSize& size = variant.effect->size();
  const EffectFeatures& searched = *variant.features;
  const BlockArray by_features =
      without_features(expanded_blocks(variant, searched, configurations, threads), searched.columns());
  worth.unmodelled = {
      size.translation, size.rotation,
      size.length,      !variant.spec->unmodelled->size,
      searched.count(), evaluate(by_features, variant.columns.parameters, prior).log_det - worth.evaluation.log_det};
  if (!variant.test_points.empty())
    fill_place_errors(variant, features, whitened, F,
                      covariance_by_visits(variant, features, configurations, among_blocks, whitened,
                                           worth.evaluation.covariance, threads),
                      worth);
  return worth;
}

}  // namespace posewright
