#include "next_known.hpp"

#include <algorithm>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/problem/design_keys.hpp"
#include "posewright/search/search.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr const char* method = "exchange";
// One pose is found by looking at all; of more, the better of two local optima.
constexpr int starts = 2;

Settings settings_of_search(Problem problem, const NextOptions& options, PoseList measured) {
  const auto state = [&](const char* key, const std::string& value) { set(problem, key, value, "next"); };
  if (!options.variant.empty()) problem.design.variant = {options.variant, 0};
  state("design.criterion", "o1");  // until it is chosen: what it needs is known then
  state("design.method", method);
  state("design.poses", std::to_string(options.poses));
  state("design.restarts", std::to_string(starts));
  if (options.candidates) state("design.candidates", std::to_string(*options.candidates));
  state("design.prior", "tolerance");
  RunOptions run;
  run.candidates_from = options.candidates_from;
  run.measured = std::move(measured);
  run.candidates_alone = true;
  run.seed = options.seed;
  run.threads = options.threads;
  return settings_of(problem, run);
}

}  // namespace

KnownSoFar::KnownSoFar(const Problem& problem, const NextOptions& options, const Monitor& monitor)
    : nominal_(problem), options_(options), monitor_(monitor), fit_(fit_so_far(problem, options, monitor)) {
  prepare();
  if (!fit_.fitted || determined()) return;
  // What tolerances alone hold is no place to plan from.
  fit_.problem = nominal_;
  fit_.fitted = false;
  fit_.noise = {};
  fit_.scale = 1.0;
  fit_.freedom = 0.0;
  fit_.effect.reset();
  prepare();
}

void KnownSoFar::prepare() {
  settle();
  reuse_candidates();
  make();
  rows_ = rows_of(study_.first(), fit_.poses);
  told_ = rank_of_readings();
}

void KnownSoFar::settle() {
  PoseList measured;
  measured.name = options_.data.string();
  for (const MeasuredPose& pose : fit_.poses) measured.configurations.push_back(pose.q);
  settings_ = settings_of_search(fit_.problem, options_, std::move(measured));
  const DesignSpec& design = nominal_.design;
  const std::string& named = options_.criterion.empty() ? design.criterion.value : options_.criterion;
  settings_.criterion_automatic = named == automatic_criterion;
  settings_.criterion = settings_.criterion_automatic ? "o1" : named;
  require_known(settings_.criterion, method, nominal_.at(design.criterion.line), {}, automatic_criterion);
  const CriterionEntry& entry = *find_criterion(settings_.criterion);
  if (entry.several_variants || (entry.needs_truth && !settings_.truth.value.empty()))
    throw CannotDo("next supports only criteria of a single variant: criterion '" + settings_.criterion +
                   "' needs several (--criterion names another)");
}

/// The study; an effect that the residuals seem to hold may still be one that the parameters take up.
void KnownSoFar::make() {
  try {
    study_ = make_study(fit_.problem, settings_, monitor_);
  } catch (const InputError&) {
    const auto own = std::find_if(fit_.problem.variants.begin(), fit_.problem.variants.end(),
                                  [&](const VariantSpec& spec) { return spec.name == nominal_spec().name; });
    if (!fit_.effect || nominal_spec().unmodelled) throw;
    own->unmodelled.reset();
    fit_.effect.reset();
    study_ = make_study(fit_.problem, settings_, monitor_);
  }
  place_tests();
}

/// Keeps the drawn candidates until the first fit.
void KnownSoFar::reuse_candidates() {
  const int asked = settings_.candidates;
  if (settings_.candidates_from || !settings_.candidates_file.empty()) return;
  if (options_.kept && options_.kept->asked == asked && options_.kept->calibrated == fit_.fitted) {
    kept_ = options_.kept;
  } else {
    const auto cell = make_cell(fit_.problem);
    const Variant placed = place_variant(fit_.problem, find_variant(fit_.problem, options_.variant), cell, monitor_);
    SamplingOptions sampling;
    sampling.count = std::size_t(asked);
    sampling.seed = settings_.planner.seed;
    sampling.threads = settings_.planner.threads;
    kept_ = std::make_shared<KeptCandidates>(
        KeptCandidates{sample_configurations(*placed.workspace, sampling, monitor_), asked, fit_.fitted});
  }
  settings_.drawn = kept_->configurations;
}

/// Default test poses: throughout the workspace.
void KnownSoFar::place_tests() {
  Variant& variant = study_.first();
  places_stated_ = !variant.test_points.empty();
  if (!places_stated_) {
    Configurations all;
    if (kept_) all = kept_->configurations;
    else all = with_measured(study_, study_.configurations);  // of a list: those that were taken from it, too
    try {
      variant.test_places.clear();
      variant.test_points = test_points_at_candidates(fit_.problem, all, variant, variant.test_places);
    } catch (const CannotDo&) {
      variant.test_points.clear();  // a robot without a tip
    }
  }
}

int KnownSoFar::rank_of_readings() const {
  if (rows_.empty()) return 0;
  Eigen::Index most = 0;
  for (const PoseRows& row : rows_) most = std::max(most, row.block.rows());
  BlockArray blocks(rows_.size(), int(most), columns());
  for (std::size_t k = 0; k < rows_.size(); ++k)
    blocks.block(k).topRows(rows_[k].block.rows()) = rows_[k].block.leftCols(columns());
  IdentifiabilityOptions exact;
  exact.threshold = exact_dependency;
  return identifiability(blocks, study_.first().columns.parameters, exact).rank;
}

}  // namespace posewright
