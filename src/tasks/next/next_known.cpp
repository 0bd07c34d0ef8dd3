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

/// Design of the search, whatever the file's own plan is.
void state_search(Problem& problem, const NextOptions& options) {
  const auto state = [&](const char* key, const std::string& value) { set(problem, key, value, "next"); };
  if (!options.variant.empty()) problem.design.variant = {options.variant, 0};
  state("design.criterion", "o1");  // until it is chosen: what it needs is known then
  state("design.method", method);
  state("design.poses", std::to_string(options.poses));
  state("design.restarts", std::to_string(starts));
  if (options.candidates) state("design.candidates", std::to_string(*options.candidates));
  state("design.prior", "tolerance");
}

RunOptions run_of(const NextOptions& options, const std::vector<MeasuredPose>& poses) {
  RunOptions run;
  run.candidates_from = options.candidates_from;
  run.measured.emplace();
  run.measured->name = options.data.string();
  for (const MeasuredPose& pose : poses) run.measured->configurations.push_back(pose.q);
  run.candidates_alone = true;
  run.seed = options.seed;
  run.threads = options.threads;
  return run;
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
  state_search(fit_.problem, options_);
  try {
    study_ = made();
  } catch (const InputError&) {
    // An effect that the residuals seem to hold may still be one that the parameters take up.
    const auto own = std::find_if(fit_.problem.variants.begin(), fit_.problem.variants.end(),
                                  [&](const VariantSpec& spec) { return spec.name == nominal_spec().name; });
    if (!fit_.effect || nominal_spec().unmodelled) throw;
    own->unmodelled.reset();
    fit_.effect.reset();
    study_ = made();
  }
  name_criterion();
  study_ = with_places(std::move(study_));
  rows_ = rows_of(study_.first(), fit_.poses);
  told_ = rank_of_readings();
}

void KnownSoFar::name_criterion() {
  const DesignSpec& design = nominal_.design;
  const std::string& named = options_.criterion.empty() ? design.criterion.value : options_.criterion;
  automatic_ = named == automatic_criterion;
  criterion_ = automatic_ ? "o1" : named;
  require_known(criterion_, method, nominal_.at(design.criterion.line), {}, automatic_criterion);
  const CriterionEntry& entry = *find_criterion(criterion_);
  if (entry.several_variants || (entry.needs_truth && study_.truth != nullptr))
    throw CannotDo("next supports only criteria of a single variant: criterion '" + criterion_ +
                   "' needs several (--criterion names another)");
}

Study KnownSoFar::made() {
  Setup setup = resolve(fit_.problem, run_of(options_, fit_.poses), monitor_);
  if (setup.candidates_from) return make_study(std::move(setup), monitor_);
  reuse_candidates(setup);
  return make_study(std::move(setup), kept_->configurations);
}

/// Keeps the drawn candidates until the first fit.
void KnownSoFar::reuse_candidates(const Setup& setup) {
  const auto fits = [&](const std::shared_ptr<const KeptCandidates>& kept) {
    return kept && kept->asked == setup.candidates && kept->calibrated == fit_.fitted;
  };
  if (fits(kept_)) return;
  kept_ = fits(options_.kept) ? options_.kept
                              : std::make_shared<const KeptCandidates>(
                                    KeptCandidates{draw_candidates(setup, monitor_), setup.candidates, fit_.fitted});
}

/// Default test poses: throughout the workspace.
Study KnownSoFar::with_places(Study study) {
  Variant& variant = study.variants.front();
  places_stated_ = !variant.test_points.empty();
  if (!places_stated_) {
    Configurations all;
    if (kept_) all = kept_->configurations;
    else all = with_measured(study, study.configurations);  // of a list: those that were taken from it, too
    try {
      variant.test_places.clear();
      variant.test_points = test_points_at_candidates(all, variant, variant.test_places);
    } catch (const CannotDo&) {
      variant.test_points.clear();  // a robot without a tip
    }
  }
  return study;
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
