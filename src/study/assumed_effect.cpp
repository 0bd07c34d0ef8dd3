#include "assumed_effect.hpp"

#include <cmath>

#include "posewright/study/unmodelled.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr int assumed_features = 32, assumed_pivots = 120;
constexpr std::size_t noise_places = 300, pivot_places = 2000, error_places = 1000;

/// Derivatives of the readings along the tip's translations at some candidates; none if they contain no tip.
BlockArray along_the_tip(const Study& study, int threads) {
  const IdentificationModel& model = *study.first().model;
  if (model.tips() == 0) return {};
  const std::vector<int> tip = {model.tip_column(0, 0), model.tip_column(0, 1), model.tip_column(0, 2)};
  return build_blocks(model, tip, thinned(study.configurations, model.coordinates(), noise_places), threads);
}

bool contain_the_tip(const BlockArray& along) { return along.count() > 0 && !along.all().isZero(0); }

std::shared_ptr<const UnmodelledEffect> effect_of(const Study& study, int threads) {
  const Variant& variant = study.first();
  if (variant.effect != nullptr) return variant.effect;
  const BlockArray along = along_the_tip(study, threads);
  if (!contain_the_tip(along))
    throw CannotDo(
        "criterion bias assumes an effect that moves the tip, but these readings contain no tip position: set design: "
        "truth, or another criterion");
  // Best over simulated robots, too (docs/real-data.md).
  const UnmodelledSize size{ExpectedError::usual_of_robots * noise_of_a_pose(along.all(), along.count()), 0.0,
                            UnmodelledSize::assumed_length};
  return std::make_shared<UnmodelledEffect>(*variant.model, size);
}

/// Raw blocks of the variant's columns, the effect's features behind them.
BlockArray with_features_last(const Variant& variant, const EffectFeatures& features,
                              const Configurations& configurations, int threads) {
  const BlockArray blocks = expanded_blocks(variant, features, configurations, threads);
  const Eigen::Index leading = features.columns(), own = blocks.columns() - leading;
  BlockArray result(blocks.count(), blocks.rows(), blocks.columns());
  result.all() << blocks.all().rightCols(own), blocks.all().leftCols(leading);
  return result;
}

/// Information from before: of the parameters as the variant has it; of the features their size, and what poses that
/// are measured already contain of them.
Eigen::MatrixXd known_with_features(const Study& study, const EffectFeatures& features, int threads,
                                    const Eigen::MatrixXd& prior) {
  const Variant& variant = study.first();
  const auto own = Eigen::Index(variant.columns.selected.size()), all = own + features.columns();
  Eigen::MatrixXd known = Eigen::MatrixXd::Zero(all, all);
  if (prior.size() > 0) {
    known.topLeftCorner(own, own) = prior.bottomRightCorner(own, own);
    if (const Configurations poses = known_before(study); poses.count() > 0) {
      // The variant's own search may have other features: what these poses say is taken anew, in one piece.
      const BlockArray before = search_blocks(variant, poses, threads);
      const auto rows = before.all().rightCols(own);
      known.topLeftCorner(own, own) -= rows.transpose() * rows;
      const BlockArray blocks = with_features_last(variant, features, poses, threads);
      known += blocks.all().transpose() * blocks.all();
    }
  }
  known.diagonal().tail(features.columns()).array() += 1;
  return known;
}

}  // namespace

bool moves_the_tip(const Study& study, int threads) { return contain_the_tip(along_the_tip(study, threads)); }

SearchPart part_with_assumed_effect(const Study& study, const Configurations& configurations, int threads,
                                    const Eigen::MatrixXd& prior) {
  const Variant& variant = study.first();
  const auto effect = effect_of(study, threads);
  const EffectFeatures features =
      EffectFeatures(effect,
                     effect_places(*effect, thinned(study.configurations, variant.model->coordinates(), pivot_places)),
                     assumed_pivots)
          .first(assumed_features);
  const auto own = Eigen::Index(variant.columns.selected.size());
  const Eigen::Index columns = features.columns();
  SearchPart part;
  part.blocks = with_features_last(variant, features, configurations, threads);
  part.nuisance = variant.columns.nuisance;
  part.scale = Eigen::VectorXd::Ones(own + columns);
  part.scale.head(own) = variant.scale;
  part.prior = known_with_features(study, features, threads, prior);
  const BlockArray places = with_features_last(
      variant, features, thinned(study.configurations, variant.model->coordinates(), error_places), threads);
  const Eigen::MatrixXd errors = places.all() / std::sqrt(double(places.count()));
  part.effects = {int(columns), Eigen::MatrixXd::Identity(columns, columns), errors.leftCols(own),
                  errors.rightCols(columns)};
  return part;
}

}  // namespace posewright
