#include "next_known.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../calibrate/calibrated_error.hpp"
#include "posewright/blocks/identifiability.hpp"
#include "posewright/calibration/placing_columns.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/lists/measured_data.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/design_keys.hpp"
#include "posewright/search/search.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"

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

// Residuals so many times the stated noise are looked into, row after row.
constexpr double suspicious = 5.0;
// A pose so many σ of its prediction away is none of this robot's: no effect that a model lacks comes near it.
constexpr double another_robot = 30.0;

VariantSpec& variant_in(Problem& problem, const std::string& name) {
  return *std::find_if(problem.variants.begin(), problem.variants.end(),
                       [&](const VariantSpec& variant) { return variant.name == name; });
}

CalibrateOptions estimate_of(const NextOptions& options, std::string text) {
  CalibrateOptions calibrate;
  calibrate.data = options.data;
  calibrate.text = std::move(text);
  calibrate.variant = options.variant;
  calibrate.prior = options.prior;
  calibrate.estimate_alone = true;
  return calibrate;
}

/// The first lines of a text, up to one that is left out.
std::string lines_before(const std::string& text, int line) {
  std::size_t end = 0;
  for (int i = 1; i < line && end < text.size(); ++i) end = std::min(text.find('\n', end), text.size() - 1) + 1;
  return text.substr(0, end);
}

class FitSoFar {
 public:
  FitSoFar(const Problem& problem, const NextOptions& options, const Monitor& monitor)
      : problem_(problem), options_(options), monitor_(monitor), spec_(find_variant(problem, options.variant)) {}

  NextFit run() {
    result_.problem = problem_;
    if (!options_.text) return std::move(result_);
    read();
    if (result_.poses.empty()) return std::move(result_);
    try {
      estimate();
    } catch (const CannotDo& error) {
      look_for_another_robot();
      result_.problem = problem_;
      result_.fitted = false;
      result_.notes.push_back(std::string("no estimate from these poses: ") + error.what());
    }
    return std::move(result_);
  }

 private:
  void read() {
    const auto model = make_model({problem_, spec_});
    MeasuredData data = parse_measured_data(*options_.text, options_.data, problem_, *model);
    result_.notes = data.notes;
    for (std::size_t k = 0; k < data.poses.size(); ++k) {
      if (data.held_back[k]) continue;
      result_.readings += int(data.poses[k].y.array().isFinite().count());
      result_.lines.push_back(data.lines[k]);
      result_.poses.push_back(std::move(data.poses[k]));
    }
  }

  void estimate() {
    Problem counting = problem_;
    Calibration found = calibrate_problem(counting, estimate_of(options_, *options_.text), monitor_);
    VariantSpec& spec = variant_in(counting, spec_.name);
    if (const auto shown = shown_effect(found); shown && !spec.unmodelled) {
      // Fitted once more: the parameters that an effect is taken for are others.
      spec.unmodelled = UnmodelledSpec{};
      found = calibrate_problem(counting, estimate_of(options_, *options_.text), monitor_);
    }
    if (!found.fit.converged) throw CannotDo("the estimate did not converge");
    if (found.fit.scale > suspicious) look_for_another_robot();
    result_.effect = found.counted;
    for (const EstimatedValue& value : found.values)
      if (value.sigma) result_.estimates.push_back(value);
    result_.noise = {options_.prior, found.fit.noise_factor};
    result_.residuals = fitted_residuals(found.fit);
    result_.scale = found.fit.scale;
    result_.freedom = found.fit.left;
    result_.problem = at_estimate(std::move(counting), spec_.name, found.values, options_.data);
    allow(variant_in(result_.problem, spec_.name).unmodelled, found);
    for_each_instrument(result_.problem.measurement, [&](MeasurementSpec& instrument) {
      for (const InstrumentResiduals& own : found.instruments)
        if (own.name == instrument.name) instrument.noise_factor = own.noise_factor;
    });
    result_.fitted = true;
  }

  /// Effect estimated from the residuals in place of the assumed one.
  void allow(std::optional<UnmodelledSpec>& effect, const Calibration& found) const {
    if (!effect || effect->size) return;
    if (found.counted) {
      effect->size = found.counted->size;
      effect->length = found.counted->length;
    } else if (found.smooth.why_not.empty()) {
      effect.reset();
    }
  }

  /// Each pose against the fit of all before it, from where these suffice for one.
  void look_for_another_robot() const {
    for (std::size_t k = 1; k < result_.poses.size() && !monitor_.should_stop(); ++k) {
      try {
        require_same_robot(k);
      } catch (const CannotDo&) {
        continue;  // too few before it
      }
    }
  }

  void require_same_robot(std::size_t k) const {
    const std::string before = lines_before(*options_.text, result_.lines[k]);
    CalibrateOptions calibrate = estimate_of(options_, before);
    // Without tolerances: poses that suffice for all parameters, or none.
    calibrate.prior = Prior::none;
    const Calibration found = calibrate_problem(problem_, calibrate, monitor_);
    if (!found.fit.converged || !(found.fit.left > 0)) return;
    const bool all = std::all_of(found.parameters.begin(), found.parameters.end(),
                                 [](const CalibratedParameter& p) { return p.estimated; });
    if (!all && !found.automatic) return;
    const Problem at = at_estimate(problem_, spec_.name, found.values, options_.data);
    const auto model = make_model({at, spec_});
    Linearisation out;
    Eigen::VectorXd y, off;
    const MeasuredPose& pose = result_.poses[k];
    if (!model->predict_and_linearise(pose.q, {}, columns_of(*model, found), out, y)) return;
    model->difference(pose.y, y, off);
    const double noise = std::pow(std::max(found.fit.noise_factor, found.fit.scale), 2);
    double farthest = 0, expected = 0;
    std::size_t worst = 0;
    for (Eigen::Index i = 0; i < off.size(); ++i) {
      if (!std::isfinite(off[i])) continue;
      const double sigma =
          std::sqrt(noise * out.covariance(i, i) + out.G.row(i) * found.fit.covariance * out.G.row(i).transpose());
      if (expected > 0 && std::abs(off[i]) / sigma <= farthest / expected) continue;
      farthest = std::abs(off[i]);
      expected = sigma;
      worst = std::size_t(i);
    }
    if (!(farthest > another_robot * expected)) return;
    const std::string& unit = model->readings()[worst].unit;
    throw InputError({options_.data.string(), result_.lines[k]},
                     fmt::format("{} is {} from its estimate by the {} before", model->readings()[worst].name,
                                 shown_value(farthest, unit), k == 1 ? "pose" : fmt::format("{} poses", k)),
                     fmt::format("some {} are expected; check for a row of another robot or a moved part",
                                 shown_value(2 * expected, unit)));
  }

  std::vector<int> columns_of(const IdentificationModel& model, const Calibration& found) const {
    const VariantColumns all = select_columns(model, {problem_, spec_});
    std::vector<int> columns;
    for (const std::string& name : found.columns)
      for (std::size_t j = 0; j < all.selected.size(); ++j)
        if (all.parameters[j].name == name) columns.push_back(all.selected[j]);
    return columns;
  }

  const Problem& problem_;
  const NextOptions& options_;
  const Monitor& monitor_;
  const VariantSpec& spec_;
  NextFit result_;
};

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

NextFit fit_so_far(const Problem& problem, const NextOptions& options, const Monitor& monitor) {
  return FitSoFar(problem, options, monitor).run();
}

}  // namespace posewright
