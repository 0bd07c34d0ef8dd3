#include "posewright/study/reliance.hpp"

#include <cmath>

#include "posewright/study/unmodelled.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

/// Mean squares at all places, m².
struct Squares {
  double noise = 0.0, effect = 0.0;
};

Squares squares_at(const std::vector<TestPoint>& points, const std::vector<TestPlace>& places,
                   const UnmodelledEffect& effect, const EffectFeatures& features, const Eigen::MatrixXd& V,
                   const Eigen::MatrixXd& follows) {
  Squares sum;
  double total = 0;
  for (std::size_t t = 0; t < points.size(); ++t) {
    const Eigen::MatrixXd phi = features.at(effect.place(places[t].q));
    const Eigen::MatrixXd moved = places[t].twists.topRows<3>();
    sum.noise += points[t].weight * (points[t].A * V * points[t].A.transpose()).trace();
    // What the features do not hold at this place is independent of all that was measured.
    double rest = 0;
    for (int k = 0; k < effect.twists(); ++k) rest += (moved.col(k) * effect.size_of(k)).squaredNorm();
    rest *= std::max(0.0, 1 - phi.squaredNorm());
    sum.effect += points[t].weight * ((points[t].A * follows - features.columns_at(phi, moved)).squaredNorm() + rest);
    total += points[t].weight;
  }
  sum.noise /= total;
  sum.effect /= total;
  return sum;
}

}  // namespace

std::optional<Reliance> reliance_of(const Problem& problem, const Study& study, const Variant& variant,
                                    const Configurations& poses, const Evaluation& evaluation, int threads) {
  const IdentificationModel& model = *variant.model;
  if (variant.effect != nullptr || model.tips() == 0) return std::nullopt;
  std::vector<TestPoint> points = variant.test_points;
  std::vector<TestPlace> places = variant.test_places;
  Reliance result;
  result.at_test_poses = !points.empty();
  if (points.empty()) {
    if (model.tips() > 1) return std::nullopt;
    points = test_points_at_candidates(problem, study.configurations, variant, places);
  }
  result.places = int(points.size());

  std::vector<int> selected = variant.columns.selected;
  const auto own = Eigen::Index(selected.size());
  for (int tip = 0; tip < model.tips(); ++tip)
    for (int k = 0; k < 3; ++k) selected.push_back(model.tip_column(tip, k));
  const BlockArray blocks = build_blocks(model, selected, poses, threads);
  result.noise = noise_of_a_pose(blocks.all().middleCols<3>(own), blocks.count());
  const auto effect =
      std::make_shared<UnmodelledEffect>(model, UnmodelledSize{result.noise, 0.0, UnmodelledSize::assumed_length});
  result.length = effect->size().length;
  const Eigen::MatrixXd at = effect_places(*effect, poses);
  const EffectFeatures features(effect, at, whole_features);
  const Eigen::MatrixXd phi = features.at(at);
  Eigen::MatrixXd along = blocks.all().rightCols(blocks.columns() - own);
  effect->take_sizes(along);
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(along.rows(), features.columns());
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    const Eigen::Index row = Eigen::Index(i) * blocks.rows();
    features.add_columns(phi.middleCols(Eigen::Index(i) * effect->tips(), effect->tips()),
                         along.middleRows(row, blocks.rows()), F.middleRows(row, blocks.rows()));
  }
  const Eigen::MatrixXd follows = evaluation.covariance * (blocks.all().leftCols(own).transpose() * F);
  const Squares squares = squares_at(points, places, *effect, features, evaluation.covariance, follows);
  result.error = std::sqrt(squares.noise);
  for (std::size_t i = 0; i < Reliance::times.size(); ++i)
    result.with[i] = std::sqrt(squares.noise + std::pow(Reliance::times[i], 2) * squares.effect);
  return result;
}

}  // namespace posewright
