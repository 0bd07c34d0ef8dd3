#include "posewright/study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "assumed_effect.hpp"
#include "criterion_choice.hpp"
#include "listed_candidates.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/model/elastic_chain.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/discrepancy.hpp"
#include "posewright/study/pose_distance.hpp"
#include "posewright/study/space.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/memory_limit.hpp"

namespace posewright {
namespace {

/// Candidates of the first variant that all others can take.
Configurations common(const std::vector<Variant>& variants, Configurations all) {
  if (variants.size() == 1) return all;
  Configurations kept;
  kept.dimension = all.dimension;
  kept.drawn = all.drawn;
  kept.rejected = all.rejected;
  long lost = 0;
  for (std::size_t i = 0; i < all.count(); ++i) {
    const bool good = std::all_of(variants.begin() + 1, variants.end(),
                                  [&](const Variant& v) { return v.workspace->violation(all[i]) < 0; });
    if (good) append(kept, all, i);
    else ++lost;
  }
  if (lost > 0) kept.rejected.emplace_back("another variant's limits", lost);
  if (kept.count() == 0) throw CannotDo("no configuration is feasible for all variants");
  return kept;
}

constexpr std::size_t norm_sample = 2000;

/// Unit of every column: its tolerance, the inverse of its mean effect on a pose's readings (where it has none and only
/// its tolerance is known: that), or 1.
Eigen::VectorXd scale_of(const Variant& variant, const Configurations& configurations, Scaling scaling, int threads) {
  const VariantColumns& columns = variant.columns;
  if (scaling == Scaling::tolerance) return tolerances_of(columns);
  const auto m = Eigen::Index(columns.selected.size());
  if (scaling == Scaling::none) return Eigen::VectorXd::Ones(m);
  const BlockArray sample = build_blocks(*variant.model, columns.selected,
                                         thinned(configurations, variant.model->coordinates(), norm_sample), threads);
  const Eigen::VectorXd effect = (sample.all().colwise().squaredNorm() / double(sample.count())).cwiseSqrt();
  return (effect.array() > 0).select(effect.cwiseInverse(), tolerances_of(columns));
}

/// Prior information on the columns of a search: tolerances, measured poses, the size of an effect.
void fill_prior(const Study& study, Variant& variant) {
  const Configurations known = known_before(study);
  if (!study.prior && known.count() == 0 && variant.features == nullptr) return;
  const auto features = variant.features == nullptr ? 0 : Eigen::Index(variant.features->columns());
  const auto m = Eigen::Index(variant.columns.selected.size());
  variant.known_before = study.prior || known.count() > 0;
  variant.prior = Eigen::MatrixXd::Zero(features + m, features + m);
  variant.prior.diagonal().head(features).setOnes();
  if (study.prior) variant.prior.diagonal().tail(m) = tolerances_of(variant.columns).cwiseAbs2().cwiseInverse();
  if (known.count() == 0) return;
  const BlockArray blocks = search_blocks(variant, known, study.planner.threads);
  variant.prior += blocks.all().transpose() * blocks.all();
}

/// All columns of the variant; those that it is to keep stand in tiers before the others.
VariantColumns columns_to_choose_from(const Variant& variant) {
  VariantColumns all = all_columns(variant);
  const std::vector<std::string>& kept = variant.kept_parameters;
  if (kept.empty() || all.tiers.empty()) return all;
  const int after = 1 + *std::ranges::max_element(all.tiers);
  for (std::size_t j = 0; j < all.tiers.size(); ++j)
    if (std::ranges::find(kept, all.parameters[j].name) == kept.end()) all.tiers[j] += after;
  return all;
}

void resolve_variant(const Study& study, Variant& variant) {
  const int threads = study.planner.threads;
  const bool known = study.prior || study.measured.count() + study.fixed.count() > 0;
  ResolvedColumns resolved =
      resolve_columns(*variant.model, study.configurations, columns_to_choose_from(variant), known, threads);
  variant.columns = std::move(resolved.columns);
  variant.dropped = std::move(resolved.dropped);
  variant.reasons = std::move(resolved.reasons);
  variant.scale = scale_of(variant, study.configurations, study.scaling, threads);
  variant.test_points = test_points_of(variant, variant.columns, study.planner.seed, &variant.test_places);
  allow_for_unmodelled(study.configurations, threads, variant);
  if (!known && study.poses)
    require_enough_poses(*variant.model, study.configurations, variant.columns, *study.poses, threads);
  fill_prior(study, variant);
}

/// Of a list, every instrument must read at some of the candidates that were drawn.
void require_every_instrument(const Study& study) {
  const std::vector<MeasurementSpec>* instruments = instruments_of(study.problem->measurement);
  if (instruments == nullptr || !study.list.empty()) return;
  const std::vector<Coordinate>& coordinates = study.first().model->coordinates();
  for (const MeasurementSpec& instrument : *instruments) {
    std::size_t i = 0;
    while (i < study.configurations.count() &&
           &instrument_at(study.problem->measurement, coordinates, study.configurations[i]) != &instrument)
      ++i;
    if (i < study.configurations.count()) continue;
    const std::string& reason = study.first().model->unmeasurable_reason();
    throw CannotDo(fmt::format("measurement: instrument '{}' reads at none of the {} candidates{}", instrument.name,
                               study.configurations.count(), reason.empty() ? "" : " (" + reason + ")"));
  }
}

/// Takes away candidates that repeat a measured or fixed pose or are nearer to one than the minimum distance, where the
/// policy forbids it. Throws CannotDo if none is left.
void keep_away_from_known(Study& study) {
  const std::size_t before = study.configurations.count();
  study.configurations = study.distance.away_from(known_before(study), study.configurations, study.repeats);
  if (const long lost = long(before - study.configurations.count()); lost > 0)
    study.configurations.rejected.emplace_back(
        fmt::format("{}{}", study.distance.kept ? "too near to a pose " : "",
                    study.fixed.count() > 0 ? "fixed or measured already" : "measured already"),
        lost);
  study.spacing = study.distance.among(study.configurations);
}

Study with_candidates(Study study, Unidentifiable unidentifiable) {
  require_every_instrument(study);
  for (Variant& variant : study.variants) {
    try {
      resolve_variant(study, variant);
    } catch (const CannotDo& error) {
      if (unidentifiable == Unidentifiable::refuse) throw;
      variant.why_not = error.what();
    }
  }
  const Problem& problem = *study.problem;
  const std::vector<Coordinate>& coordinates = study.first().workspace->coordinates();
  if (std::string warning = compensator_warning(problem.robot, coordinates); !warning.empty())
    study.notes.push_back(std::move(warning));
  study.notes.insert(study.notes.end(), study.fixed_notes.begin(), study.fixed_notes.end());
  study.distance = pose_distance(study, known_before(study), study.poses);
  if (study.poses) study.distance.require_room(*study.poses - int(study.fixed.count()));
  keep_away_from_known(study);
  if (study.truth != nullptr) study.discrepancy = make_discrepancy(study);
  return study;
}

// Bytes that a plan takes beside its candidates, and of each candidate beside its blocks: configuration, sensitivities.
// Measured for each: 3.4 kB (KR 270, 60,000 candidates), estimated 3.4; 3.9 kB (Gough), 5.1.
constexpr double beside_candidates = 64e6, beside_blocks = 500;

/// Throws CannotDo where so many candidates would not fit into memory: before they are drawn, since a process that
/// takes more than there is ends without a word. Of an automatic variant all columns count, so it is an upper estimate.
void require_memory(const Setup& setup, std::size_t candidates) {
  double each = beside_blocks;
  for (const Variant& variant : setup.variants) {
    const std::vector<int> columns = all_columns(variant).selected;
    const BlockArray one(1, variant.model->block_rows(columns), int(columns.size()));
    each += double(sizeof(double)) * one.rows() * one.stride();
  }
  const double needed = beside_candidates + each * double(candidates), most = double(memory_limit());
  if (needed <= most) return;
  throw CannotDo(
      fmt::format("{} candidates need up to {:.1f} GB of memory, and {:.1f} GB is all there is; ask for at most {}",
                  candidates, 1e-9 * needed, 1e-9 * most, std::max(0L, long((most - beside_candidates) / each))));
}

}  // namespace

Configurations chosen_by(const Design& design, const Configurations& candidates) {
  Configurations chosen;
  chosen.dimension = candidates.dimension;
  const std::size_t n = candidates.count();
  for (const int i : design.members)
    append(chosen,
           std::size_t(i) < n ? candidates[std::size_t(i)] : std::span<const double>(design.added[std::size_t(i) - n]));
  return chosen;
}

Configurations without(const Configurations& list, const std::vector<int>& left_out) {
  Configurations left;
  left.dimension = list.dimension;
  for (std::size_t i = 0; i < list.count(); ++i)
    if (std::find(left_out.begin(), left_out.end(), int(i)) == left_out.end()) append(left, list[i]);
  return left;
}

void append(Configurations& list, std::span<const double> q) {
  list.values.insert(list.values.end(), q.begin(), q.end());
}

Configurations known_before(const Setup& setup) { return with_measured(setup, setup.fixed); }

Configurations with_measured(const Setup& setup, const Configurations& poses) {
  Configurations all = setup.measured;
  all.dimension = poses.dimension;
  all.values.insert(all.values.end(), poses.values.begin(), poses.values.end());
  return all;
}

void append(Configurations& list, const Configurations& from, std::size_t i) {
  append(list, from[i]);
  if (!from.rows.empty()) list.rows.push_back(from.rows[i]);
}

Configurations draw_candidates(const Setup& setup, const Monitor& monitor) {
  SamplingOptions sampling;
  sampling.count = std::size_t(setup.candidates);
  sampling.seed = setup.planner.seed;
  sampling.threads = setup.planner.threads;
  return sample_configurations(*setup.first().workspace, sampling, monitor);
}

Study make_study(Setup setup, Configurations drawn, Unidentifiable unidentifiable) {
  Study study{std::move(setup)};
  study.configurations = common(study.variants, std::move(drawn));
  return with_candidates(std::move(study), unidentifiable);
}

Study make_study(Setup setup, const Monitor& monitor, Unidentifiable unidentifiable) {
  require_memory(setup,
                 setup.candidates_from ? setup.candidates_from->configurations.size() : std::size_t(setup.candidates));
  if (!setup.candidates_from) {
    Configurations drawn = draw_candidates(setup, monitor);
    return make_study(std::move(setup), std::move(drawn), unidentifiable);
  }
  Study study{std::move(setup)};
  take_listed_candidates(study);
  return with_candidates(std::move(study), unidentifiable);
}

SearchRequest search_request(const Setup& setup, int poses) {
  SearchRequest request;
  // Weights over the columns of an assumed effect bound nothing.
  request.certify = !assumes_effect(setup);
  request.criterion = setup.criterion;
  request.method = setup.method;
  request.poses = poses;
  request.repeats = setup.repeats;
  request.reserve = setup.reserve;
  request.planner = setup.planner;
  return request;
}

SearchRequest spaced_request(const Study& study, int poses) {
  SearchRequest request = search_request(study, poses);
  if (study.spacing) request.spacing = &*study.spacing;
  return request;
}

std::function<std::unique_ptr<ConfigurationSpace>(const Eigen::MatrixXd& R)> space_maker(const Study& study,
                                                                                         const std::string& criterion) {
  return space_maker(study, criterion, study.configurations, known_before(study), study.distance.spacing);
}

std::function<std::unique_ptr<ConfigurationSpace>(const Eigen::MatrixXd& R)> space_maker(
    const Study& study, const std::string& criterion, const Configurations& candidates, const Configurations& known,
    const Spacing& spacing) {
  const bool with_effects = find_criterion(criterion)->needs_truth;
  // An effect that is assumed says too little for moves between candidates; moves of single joints open a loop.
  if (!study.list.empty() || study.first().workspace->closure() != nullptr ||
      (with_effects && study.discrepancy == nullptr))
    return {};
  return [&study, with_effects, &candidates, known, &spacing](const Eigen::MatrixXd& R) {
    std::vector<SpacePart> parts;
    for (const Variant& v : study.variants)
      parts.push_back({v.model.get(), v.workspace.get(), v.columns.selected, {}, v.features.get()});
    if (with_effects) {
      parts.front().selected = study.discrepancy->effects.columns.selected;
      parts.front().mix = study.discrepancy->mix;
      parts.front().features = nullptr;
    }
    return make_configuration_space(std::move(parts), candidates, known, spacing, R);
  };
}

namespace {

/// Test points as the columns of a search have them.
std::vector<TestPoint> test_points_with_features(const Variant& variant) {
  if (variant.features == nullptr) return variant.test_points;
  std::vector<TestPoint> points;
  for (std::size_t t = 0; t < variant.test_places.size(); ++t) {
    const TestPoint& own = variant.test_points[t];
    const TestPlace& place = variant.test_places[t];
    const Eigen::MatrixXd B =
        variant.features->columns_at(variant.features->at(variant.effect->place(place.q)).col(0), place.twists);
    TestPoint point{Eigen::MatrixXd(3, B.cols() + own.A.cols()), own.weight, {}};
    point.A << B.topRows<3>(), own.A;
    points.push_back(std::move(point));
  }
  return points;
}

SearchPart search_part(const Variant& variant, const Configurations& configurations, int threads,
                       const Eigen::MatrixXd& prior) {
  const int features = variant.features == nullptr ? 0 : variant.features->columns();
  SearchPart part;
  part.blocks = search_blocks(variant, configurations, threads);
  part.nuisance = variant.nuisance_counts ? 0 : features + variant.columns.nuisance;
  part.weight = variant.weight;
  part.scale = Eigen::VectorXd::Ones(features + variant.scale.size());
  part.scale.tail(variant.scale.size()) = variant.scale;
  part.test_points = test_points_with_features(variant);
  part.prior = prior;
  return part;
}

}  // namespace

std::vector<SearchPart> search_parts(const Variant& variant, const Configurations& configurations, int threads) {
  std::vector<SearchPart> parts;
  parts.push_back(search_part(variant, configurations, threads, variant.prior));
  return parts;
}

std::vector<SearchPart> search_parts(const Study& study, const std::string& criterion,
                                     const Configurations& configurations, int threads, const Eigen::MatrixXd* known) {
  const auto prior = [&](const Variant& variant) -> const Eigen::MatrixXd& { return known ? *known : variant.prior; };
  std::vector<SearchPart> parts;
  if (find_criterion(criterion)->needs_truth) {
    parts.push_back(study.discrepancy == nullptr
                        ? part_with_assumed_effect(study, configurations, threads, prior(study.first()))
                        : part_with_effects(study, configurations, threads));
    return parts;
  }
  for (const Variant& variant : study.variants)
    parts.push_back(search_part(variant, configurations, threads, prior(variant)));
  return parts;
}

std::vector<SearchPart> copied_parts(const std::vector<SearchPart>& parts) {
  std::vector<SearchPart> copies;
  for (const SearchPart& part : parts) {
    std::vector<int> all(part.blocks.count());
    std::iota(all.begin(), all.end(), 0);
    copies.push_back(
        {part.blocks.subset(all), part.nuisance, part.weight, part.scale, part.test_points, part.prior, part.effects});
  }
  return copies;
}

}  // namespace posewright
