#include "posewright/study/unmodelled.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "posewright/model/independent_rows.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr int fewest_features = 2, most_features = 32, pivots = 120;
// Loss of efficiency by features in place of the whole effect that does not matter.
constexpr double feature_loss = 0.01;
// More features do not pay if the most of them leave so large a share of the error of a few.
constexpr double little_better = 1.5;
// Sets of candidates that judge the features, and poses of each that are enough to.
constexpr int judged_sets = 3, fewest_judged = 12, most_judged = 60;
constexpr std::uint64_t judged_stream = 0x9a7e;
// Candidates that size and smoothness are judged by; more only cost time.
constexpr std::size_t size_sample = 300, pivot_sample = 2000;
// Of the effect's variance: what estimated parameters leave of an effect that can be told from them.
constexpr double told_apart = 0.01;

/// Parameters that somebody reckons with and that the variant neither estimates nor fixes nor could tell from those it
/// estimates: other variants of the file estimate them, or it states their tolerance. A catalogue holds more.
std::vector<Parameter> not_estimated(const Variant& variant, std::vector<int>& indices) {
  const Problem& problem = *variant.problem;
  std::vector<int> known = fixed_parameters(*variant.model, {problem, *variant.spec});
  known.insert(known.end(), variant.columns.selected.begin(), variant.columns.selected.end());
  std::set<std::string> dropped;
  for (const Parameter& p : variant.dropped) dropped.insert(p.name);
  std::vector<Parameter> rest;
  const auto take = [&](int i, const Parameter& label) {
    if (!(label.tolerance > 0) || dropped.count(label.name) != 0 ||
        std::find(known.begin(), known.end(), i) != known.end())
      return;
    known.push_back(i);
    indices.push_back(i);
    rest.push_back(label);
  };
  for (const VariantSpec& other : problem.variants) {
    if (other.convention != variant.spec->convention) continue;
    const VariantColumns columns = select_columns(*variant.model, {problem, other});
    for (std::size_t j = 0; j < columns.selected.size(); ++j) take(columns.selected[j], columns.parameters[j]);
  }
  return rest;
}

/// @param rows  along what the effect moves
void require_displacements(const Variant& variant, const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  if (rows.isZero(0))
    throw InputError(variant.problem->at(variant.spec->unmodelled->line),
                     "an unmodelled effect displaces the tip, and the instrument reads angles alone",
                     "leave unmodelled out");
}

double size_by_tolerances(const Variant& variant, const Configurations& sample, int threads) {
  std::vector<int> indices;
  const std::vector<Parameter> rest = not_estimated(variant, indices);
  std::vector<int> selected = variant.columns.selected;
  const auto own = Eigen::Index(selected.size());
  selected.insert(selected.end(), indices.begin(), indices.end());
  for (int k = 0; k < 3; ++k) selected.push_back(variant.model->tip_column(0, k));
  const BlockArray blocks = build_blocks(*variant.model, selected, sample, threads);
  const auto Y = blocks.all().rightCols<3>();
  require_displacements(variant, Y);
  const double noise = noise_of_a_pose(Y, blocks.count());
  if (rest.empty()) return noise;
  Eigen::MatrixXd caused = blocks.all().middleCols(own, Eigen::Index(rest.size()));
  for (std::size_t j = 0; j < rest.size(); ++j) caused.col(Eigen::Index(j)) *= rest[j].tolerance;
  const Eigen::MatrixXd left = left_beside(blocks.all().leftCols(own), caused);
  double squares = 0;
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    const Eigen::Index row = Eigen::Index(i) * blocks.rows();
    const Eigen::MatrixXd A = Y.middleRows(row, blocks.rows());
    squares += A.completeOrthogonalDecomposition().solve(left.middleRows(row, blocks.rows())).squaredNorm();
  }
  return std::max(noise, std::sqrt(squares / (3.0 * double(blocks.count()))));
}

void require_told_apart(const Variant& variant, const Configurations& sample, int threads) {
  const EffectFeatures features(variant.effect, effect_places(*variant.effect, sample), most_features);
  const BlockArray blocks = expanded_blocks(variant, features, sample, threads);
  const Eigen::MatrixXd F = blocks.all().leftCols(features.columns());
  require_displacements(variant, F);
  const Eigen::MatrixXd left = left_beside(blocks.all().rightCols(blocks.columns() - features.columns()), F);
  if (left.squaredNorm() > told_apart * F.squaredNorm()) return;
  throw InputError(variant.problem->at(variant.spec->unmodelled->line),
                   fmt::format("an unmodelled effect with a length of {:.3g} deg is almost absorbed by the parameters "
                               "of variant '{}': {:.2g} % of it remains over the workspace",
                               variant.effect->size().length * 180 / std::numbers::pi, variant.spec->name,
                               100 * left.squaredNorm() / F.squaredNorm()),
                   "a shorter length, or no `unmodelled`");
}

/// log det of the estimated parameters by these features, nuisance ones included.
double log_det_by(const Variant& variant, const EffectFeatures& features, const Configurations& poses, int threads) {
  const BlockArray blocks = without_features(expanded_blocks(variant, features, poses, threads), features.columns());
  Eigen::MatrixXd J(blocks.all());
  const Eigen::VectorXd length = J.colwise().norm().cwiseMax(1e-300);
  J *= length.cwiseInverse().asDiagonal();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(J);
  const Eigen::Index m = std::min(J.rows(), J.cols());
  return 2 * (qr.matrixQR().diagonal().head(m).cwiseAbs().cwiseMax(1e-12).array() * length.head(m).array()).log().sum();
}

std::vector<Configurations> sets_of(const Configurations& candidates, int poses) {
  std::vector<Configurations> sets(judged_sets);
  Random random(0, judged_stream);
  for (Configurations& set : sets) {
    set.dimension = candidates.dimension;
    for (int i = 0; i < poses; ++i) append(set, candidates[std::size_t(random.uniform() * double(candidates.count()))]);
  }
  return sets;
}

std::shared_ptr<const EffectFeatures> enough_features(const Variant& variant, const Configurations& candidates,
                                                      int threads) {
  const auto& effect = variant.effect;
  const Eigen::MatrixXd among = effect_places(*effect, thinned(candidates, variant.model->coordinates(), pivot_sample));
  // More than determine the parameters: where these stand on the brink, a feature more or less says little.
  const int rows = variant.model->block_rows(variant.columns.selected),
            all_columns = int(variant.columns.selected.size());
  const int wanted = std::clamp(3 * all_columns / rows + 2, fewest_judged, most_judged);
  const std::vector<Configurations> sets = sets_of(candidates, wanted);
  std::vector<double> whole;
  for (const Configurations& set : sets)
    whole.push_back(log_det_by(variant, {effect, effect_places(*effect, set), whole_features}, set, threads));
  const EffectFeatures all(effect, among, pivots);
  const auto error_of = [&](const EffectFeatures& features) {
    double worst = 0;
    for (std::size_t s = 0; s < sets.size(); ++s)
      worst = std::max(worst, std::abs(log_det_by(variant, features, sets[s], threads) - whole[s]));
    return worst;
  };
  // In six joints poses are hardly correlated, and no number of features holds what little they are.
  const double allowed = std::max(feature_loss * double(variant.columns.selected.size()),
                                  little_better * error_of(all.first(most_features)));
  for (int count = fewest_features; count < most_features; count = (5 * count + 3) / 4)
    if (error_of(all.first(count)) <= allowed) return std::make_shared<EffectFeatures>(all.first(count));
  return std::make_shared<EffectFeatures>(all.first(most_features));
}

}  // namespace

Eigen::MatrixXd left_beside(const Eigen::MatrixXd& others, const Eigen::MatrixXd& columns) {
  const Eigen::VectorXd length = others.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd unit = others * length.cwiseInverse().asDiagonal();
  return columns - unit * Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(unit).solve(columns);
}

double noise_of_a_pose(const Eigen::Ref<const Eigen::MatrixXd>& A, std::size_t n) {
  return std::sqrt(3.0 * double(n) / A.squaredNorm());
}

Eigen::MatrixXd effect_places(const UnmodelledEffect& effect, const Configurations& configurations) {
  Eigen::MatrixXd all;
  for (std::size_t i = 0; i < configurations.count(); ++i) {
    const Eigen::MatrixXd f = effect.places(configurations[i]);
    if (i == 0) all.resize(f.rows(), Eigen::Index(configurations.count()) * f.cols());
    all.middleCols(Eigen::Index(i) * f.cols(), f.cols()) = f;
  }
  return all;
}

BlockArray expanded_blocks(const Variant& variant, const EffectFeatures& features, const Configurations& configurations,
                           int threads, const std::vector<int>& others) {
  std::vector<int> own = variant.columns.selected;
  own.insert(own.end(), others.begin(), others.end());
  std::vector<int> all = own;
  all.insert(all.end(), features.effect().columns().begin(), features.effect().columns().end());
  const BlockArray raw = build_blocks(*variant.model, all, configurations, threads);
  BlockArray blocks(raw.count(), raw.rows(), features.columns() + int(own.size()));
  constexpr std::size_t chunk = 64;
  parallel_for((raw.count() + chunk - 1) / chunk, thread_count(threads), [&](std::size_t c, int) {
    for (std::size_t i = c * chunk; i < std::min(raw.count(), (c + 1) * chunk); ++i)
      features.expand(configurations[i], raw.block(i), blocks.block(i));
  });
  return blocks;
}

void allow_for_unmodelled(const Configurations& candidates, int threads, Variant& variant) {
  if (!variant.spec->unmodelled) return;
  const UnmodelledSpec& spec = *variant.spec->unmodelled;
  // What a calibration found stands for what nobody states.
  const std::optional<CalibratedParameters>& calibrated = variant.problem->parameters;
  const CalibratedEffect* found = calibrated && calibrated->unmodelled ? &*calibrated->unmodelled : nullptr;
  const Configurations sample = thinned(candidates, variant.model->coordinates(), size_sample);
  UnmodelledSize size{1.0, spec.rotation,
                      spec.length.value_or(found != nullptr ? found->length : UnmodelledSize::assumed_length)};
  variant.effect = std::make_shared<UnmodelledEffect>(*variant.model, size);
  require_told_apart(variant, sample, threads);
  size.translation = spec.size          ? *spec.size
                     : found != nullptr ? found->size
                                        : size_by_tolerances(variant, sample, threads);
  size.own = own_effects(variant.problem->measurement);
  variant.effect = std::make_shared<UnmodelledEffect>(*variant.model, size);
  variant.features = enough_features(variant, candidates, threads);
}

BlockArray search_blocks(const Variant& variant, const Configurations& configurations, int threads) {
  if (variant.features == nullptr)
    return build_blocks(*variant.model, variant.columns.selected, configurations, threads);
  return expanded_blocks(variant, *variant.features, configurations, threads);
}

}  // namespace posewright
