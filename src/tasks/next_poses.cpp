#include "posewright/tasks/next_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fill_plan.hpp"
#include "next_fit.hpp"
#include "posewright/blocks/identifiability.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/search/search.hpp"
#include "posewright/study/forecast.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/repeats.hpp"

namespace posewright {
namespace {

// As in a plan: from so many times the smallest number of poses on there is enough to choose by what is predicted.
constexpr double enough_to_predict = 1.5;
constexpr const char* method = "exchange";
// One pose is found by looking at all; of more, the better of two local optima.
constexpr int starts = 2;

PlanOptions plan_options(const NextOptions& options, const PoseList& measured) {
  PlanOptions plan;
  plan.variant = options.variant;
  plan.criterion = "o1";  // until it is chosen: what it needs is known then
  plan.method = method;
  plan.poses = options.poses;
  plan.restarts = starts;
  plan.candidates = options.candidates;
  plan.candidates_from = options.candidates_from;
  plan.prior = true;
  plan.measured = measured;
  plan.fixed = PoseList{};
  plan.candidates_alone = true;
  plan.seed = options.seed;
  plan.threads = options.threads;
  return plan;
}

class NextRun {
 public:
  NextRun(const Problem& problem, const NextOptions& options, const Monitor& monitor)
      : options_(options), monitor_(monitor), nominal_(problem), fit_(fit_so_far(problem, options, monitor)) {
    result_.notes = fit_.notes;
    result_.required = options.required ? options.required : problem.design.require.accuracy;
    prepare();
    if (fit_.fitted && told_ < columns()) {
      // What tolerances alone hold is no place to plan from.
      fit_.problem = nominal_;
      fit_.fitted = false;
      fit_.noise = {};
      fit_.effect.reset();
      prepare();
    }
  }

  NextPoses run() {
    describe_known();
    choose_criterion();
    const SearchParts parts = parts_for(result_.criterion);
    const Configurations chosen = search_for(parts, result_.criterion, options_.poses);
    forecast(chosen);
    fill_poses(chosen);
    judge();
    result_.interrupted = monitor_.was_interrupted();
    return std::move(result_);
  }

 private:
  using SearchParts = std::vector<SearchPart>;

  void prepare() {
    PoseList measured;
    measured.name = options_.data.string();
    for (const MeasuredPose& pose : fit_.poses) measured.configurations.push_back(pose.q);
    settings_ = settings_of(fit_.problem, plan_options(options_, measured));
    const DesignSpec& design = nominal_.design;
    settings_.criterion_stated = !options_.criterion.empty() || design.criterion.line > 0;
    settings_.criterion = options_.criterion.empty() ? design.criterion.value : options_.criterion;
    require_known(settings_.criterion, method, nominal_.at(design.criterion.line), {});
    if (find_criterion(settings_.criterion)->several_variants || find_criterion(settings_.criterion)->needs_truth)
      throw CannotDo("next estimates one variant and asks no other: criterion '" + settings_.criterion +
                     "' needs several (--criterion names another)");
    settings_.fixed.reset();
    reuse_candidates();
    make();
    rows_ = rows_of(study_.first(), fit_.poses);
    told_ = rank_of_readings();
  }

  /// The study; an effect that the residuals seem to hold may still be one that the parameters take up.
  void make() {
    try {
      study_ = make_study(fit_.problem, settings_, monitor_);
    } catch (const InputError&) {
      VariantSpec* spec = variant_spec();
      if (!fit_.effect || spec == nullptr || nominal_spec().unmodelled) throw;
      spec->unmodelled.reset();
      fit_.effect.reset();
      study_ = make_study(fit_.problem, settings_, monitor_);
    }
    place_tests();
  }

  const VariantSpec& nominal_spec() const { return find_variant(nominal_, options_.variant); }
  VariantSpec* variant_spec() {
    for (VariantSpec& spec : fit_.problem.variants)
      if (spec.name == nominal_spec().name) return &spec;
    return nullptr;
  }

  /// What was drawn once serves until the first fit says where the robot stands.
  void reuse_candidates() {
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

  /// Where accuracy counts, if the problem does not say: through the workspace.
  void place_tests() {
    Variant& variant = study_.first();
    result_.places_stated = !variant.test_points.empty();
    if (!result_.places_stated) {
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
    result_.places = int(variant.test_points.size());
  }

  int columns() const { return int(study_.first().columns.selected.size()); }

  /// How many columns the readings tell, whatever tolerances say.
  int rank_of_readings() const {
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

  bool determined() const { return told_ == columns(); }

  void describe_known() {
    const Variant& variant = study_.first();
    result_.variant = variant.spec->name;
    result_.measured = int(fit_.poses.size());
    result_.readings = fit_.readings;
    result_.parameters = columns();
    result_.told = told_;
    result_.fitted = fit_.fitted;
    result_.noise = fit_.noise.scale;
    result_.freedom = fit_.fitted ? fit_.noise.freedom : 0;
    result_.effect = fit_.effect;
    if (fit_.fitted) result_.estimates = fit_.estimates;
    result_.kept = kept_;
    result_.smallest = smallest_number_of_poses(*variant.model, study_.configurations, variant.columns,
                                                settings_.planner.threads);
    result_.candidates = study_.list.empty()
                             ? fmt::format("{} candidates", study_.configurations.count())
                             : fmt::format("{} candidates of {}", study_.configurations.count(), study_.list);
    result_.notes.insert(result_.notes.end(), study_.notes.begin(), study_.notes.end());
  }

  void choose_criterion() {
    result_.criterion = settings_.criterion;
    result_.criterion_stated = settings_.criterion_stated;
    const bool places = result_.places > 0;
    if (!settings_.criterion_stated && places && determined() && result_.smallest &&
        result_.measured >= enough_to_predict * *result_.smallest)
      result_.criterion = "test_pose";
    if (find_criterion(result_.criterion)->needs_test_poses && !places)
      throw CannotDo("criterion '" + result_.criterion + "' needs places where accuracy matters, and this robot has no tip");
  }

  /// Candidates beside what is known.
  SearchParts parts_for(const std::string& criterion) {
    Variant& variant = study_.first();
    const Prior prior = determined() ? options_.prior : Prior::every;
    variant.prior = known_information(variant, rows_, prior, fit_.noise.factor);
    return search_parts(study_, criterion, study_.configurations, settings_.planner.threads);
  }

  /// The best that are feasible at the estimated values, too.
  Configurations search_for(const SearchParts& parts, const std::string& criterion, int poses) {
    SearchRequest request = spaced_request(study_, settings_, poses);
    request.criterion = criterion;
    request.certify = false;
    request.planner.kicks = 0;
    if (poses == 1) request.planner.restarts = 1;
    const SearchResult found = search(copied_parts(parts), request, monitor_);
    Configurations chosen;
    chosen.dimension = study_.configurations.dimension;
    for (const int member : found.design.members) append(chosen, study_.configurations, std::size_t(member));
    if (!study_.list.empty() || all_feasible(chosen)) return in_order(chosen);
    remove_infeasible();
    return search_for(search_parts(study_, criterion, study_.configurations, settings_.planner.threads), criterion,
                      poses);
  }

  bool all_feasible(const Configurations& chosen) const {
    for (std::size_t i = 0; i < chosen.count(); ++i)
      if (study_.first().workspace->violation(chosen[i]) >= 0) return false;
    return true;
  }

  /// Drawn at other values: the whole set is looked at once.
  void remove_infeasible() {
    const Configurations all = study_.configurations;
    study_.configurations.values.clear();
    for (std::size_t i = 0; i < all.count(); ++i)
      if (study_.first().workspace->violation(all[i]) < 0) append(study_.configurations, all, i);
    if (study_.configurations.count() == 0) throw CannotDo("no candidate is feasible at the estimated values");
    keep_away_from_measured(study_, settings_.repeats);
  }

  /// The pose that tells most first: whoever measures one only measures that.
  Configurations in_order(const Configurations& chosen) const {
    if (chosen.count() < 2 || result_.places == 0) return chosen;
    const std::vector<PoseRows> more = rows_of(study_.first(), chosen, settings_.planner.threads);
    const ForecastOfError error(study_.first(), noise());
    Configurations ordered;
    ordered.dimension = chosen.dimension;
    std::vector<PoseRows> known = rows_;
    std::set<std::size_t> left;
    for (std::size_t i = 0; i < chosen.count(); ++i) left.insert(i);
    while (!left.empty()) {
      std::size_t best = *left.begin();
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t i : left) {
        known.push_back(more[i]);
        const auto after = error.after_each(known, known.size()).back();
        known.pop_back();
        if (after && after->expected < least) {
          least = after->expected;
          best = i;
        }
      }
      append(ordered, chosen, best);
      known.push_back(more[best]);
      left.erase(best);
    }
    return ordered;
  }

  ForecastNoise noise() const {
    ForecastNoise noise = fit_.noise;
    noise.prior = options_.prior;
    return noise;
  }

  NextPoint point(std::size_t poses, const std::optional<ForecastError>& error) const {
    NextPoint point{int(poses)};
    if (!error) return point;
    point.expected = error->expected;
    if (std::isfinite(error->upper)) point.upper = error->upper;
    return point;
  }

  void forecast(const Configurations& chosen) {
    if (result_.places == 0) return;
    const ForecastOfError error(study_.first(), noise());
    std::vector<PoseRows> all = rows_;
    for (PoseRows& row : rows_of(study_.first(), chosen, settings_.planner.threads)) all.push_back(std::move(row));
    const auto errors = error.after_each(all);
    for (std::size_t n = 0; n < errors.size(); ++n)
      (n <= rows_.size() ? result_.curve : result_.ahead).push_back(point(n, errors[n]));
    if (!determined()) return;
    const int ahead = std::min(poses_looked_ahead, int(study_.configurations.count()));
    const Configurations three = search_for(parts_for("test_pose"), "test_pose", ahead);
    all.resize(rows_.size());
    for (PoseRows& row : rows_of(study_.first(), three, settings_.planner.threads)) all.push_back(std::move(row));
    result_.with_three = point(all.size(), error.after_each(all, all.size()).back());
  }

  void fill_poses(const Configurations& chosen) {
    const IdentificationModel& model = *study_.first().model;
    for (std::size_t i = 0; i < chosen.count(); ++i) {
      PlannedPose pose = pose_of(model, chosen[i]);
      pose.id = result_.measured + int(i) + 1;
      if (!chosen.rows.empty()) pose.listed = PlannedPose::Listed{chosen.rows[i].id, chosen.rows[i].line};
      pose.nearest = nearest_at(*study_.cell, chosen[i]);
      result_.poses.push_back(std::move(pose));
    }
  }

  void judge() {
    if (!determined() || !fit_.fitted || result_.curve.empty() || !result_.curve.back().expected) return;
    const NextPoint& now = result_.curve.back();
    result_.verdict = NextVerdict::go_on;
    if (result_.required && now.upper && *now.upper <= *result_.required) result_.verdict = NextVerdict::reached;
    else if (result_.with_three && result_.with_three->expected &&
             *result_.with_three->expected > (1 - least_gain) * *now.expected)
      result_.verdict = NextVerdict::flat;
  }

  const NextOptions& options_;
  const Monitor& monitor_;
  const Problem& nominal_;
  NextFit fit_;
  Settings settings_;
  Study study_;
  std::shared_ptr<const KeptCandidates> kept_;
  std::vector<PoseRows> rows_;
  int told_ = 0;
  NextPoses result_;
};

}  // namespace

NextPoses next_poses(const Problem& problem, const NextOptions& options, const Monitor& monitor) {
  return NextRun(problem, options, monitor).run();
}

}  // namespace posewright
