#include "posewright/tasks/next_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <set>

#include "../fill_plan.hpp"
#include "next_known.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/search/search.hpp"
#include "posewright/study/error_limits.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/forecast.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// As in a plan: from so many times the smallest number of poses on there is enough to choose by what is predicted.
constexpr double enough_to_predict = 1.5;

class NextRun {
 public:
  NextRun(const Problem& problem, const NextOptions& options, const Monitor& monitor)
      : options_(options), monitor_(monitor), known_(problem, options, monitor), study_(known_.study()) {
    candidates_ = study_.configurations;
    spacing_ = study_.spacing;
    result_.required = options.required ? options.required : problem.design.require.accuracy;
  }

  NextPoses run() {
    describe_known();
    choose_criterion();
    const SearchParts parts = parts_for(result_.criterion);
    const Configurations chosen = search_for(parts, result_.criterion, options_.poses);
    forecast(chosen);
    fill_requirements();
    fill_poses(chosen);
    judge();
    result_.interrupted = monitor_.was_interrupted();
    return std::move(result_);
  }

 private:
  using SearchParts = std::vector<SearchPart>;

  void describe_known() {
    const Variant& variant = study_.first();
    result_.variant = variant.spec->name;
    result_.measured = int(known_.fit().poses.size());
    result_.readings = known_.fit().readings;
    result_.parameters = known_.columns();
    result_.told = known_.told();
    result_.fitted = known_.fit().fitted;
    result_.noise = known_.fit().scale;
    result_.freedom = known_.fit().freedom;
    result_.effect = known_.fit().effect;
    if (known_.fit().fitted) result_.estimates = known_.fit().estimates;
    result_.kept = known_.kept();
    result_.places = int(variant.test_points.size());
    result_.places_stated = known_.places_stated();
    result_.smallest =
        smallest_number_of_poses(*variant.model, study_.configurations, variant.columns, study_.planner.threads);
    result_.candidates = study_.list.empty()
                             ? fmt::format("{} candidates", study_.configurations.count())
                             : fmt::format("{} candidates of {}", study_.configurations.count(), study_.list);
    result_.notes = known_.fit().notes;
    result_.notes.insert(result_.notes.end(), study_.notes.begin(), study_.notes.end());
  }

  void choose_criterion() {
    result_.criterion = known_.criterion();
    const bool places = result_.places > 0;
    if (known_.criterion_automatic() && places && known_.determined() && result_.smallest &&
        result_.measured >= enough_to_predict * *result_.smallest)
      result_.criterion = "test_pose";
    if (find_criterion(result_.criterion)->needs_test_poses && !places)
      throw CannotDo("criterion '" + result_.criterion + "' needs test poses, and this robot has no tip");
  }

  /// Candidates beside what is known.
  SearchParts parts_for(const std::string& criterion) {
    const Prior prior = known_.determined() ? options_.prior : Prior::every;
    information_ = known_information(study_.first(), known_.rows(), prior, known_.fit().noise.factor);
    return parts_of(criterion);
  }

  SearchParts parts_of(const std::string& criterion) const {
    return search_parts(study_, criterion, candidates_, study_.planner.threads, &information_);
  }

  /// The best that are feasible at the estimated values, too.
  Configurations search_for(const SearchParts& parts, const std::string& criterion, int poses) {
    SearchRequest request = search_request(study_, poses);
    if (spacing_) request.spacing = &*spacing_;
    request.criterion = criterion;
    request.certify = false;
    request.planner.kicks = 0;
    if (poses == 1) request.planner.restarts = 1;
    const SearchResult found = search(copied_parts(parts), request, monitor_);
    Configurations chosen;
    chosen.dimension = candidates_.dimension;
    for (const int member : found.design.members) append(chosen, candidates_, std::size_t(member));
    if (!study_.list.empty() || all_feasible(chosen)) return in_order(chosen);
    remove_infeasible();
    return search_for(parts_of(criterion), criterion, poses);
  }

  bool all_feasible(const Configurations& chosen) const {
    for (std::size_t i = 0; i < chosen.count(); ++i)
      if (study_.first().workspace->violation(chosen[i]) >= 0) return false;
    return true;
  }

  /// Drawn at other values: the whole set is looked at once.
  void remove_infeasible() {
    const Configurations all = candidates_;
    candidates_.values.clear();
    for (std::size_t i = 0; i < all.count(); ++i)
      if (study_.first().workspace->violation(all[i]) < 0) append(candidates_, all[i]);
    if (candidates_.count() == 0) throw CannotDo("no candidate is feasible at the estimated values");
    spacing_ = study_.distance.among(candidates_);
  }

  /// The pose that tells most first: whoever measures one only measures that.
  Configurations in_order(const Configurations& chosen) const {
    if (chosen.count() < 2 || result_.places == 0) return chosen;
    const std::vector<PoseRows> more = rows_of(study_.first(), chosen, study_.planner.threads);
    const ForecastOfError error(study_.first(), noise());
    Configurations ordered;
    ordered.dimension = chosen.dimension;
    std::vector<PoseRows> known = known_.rows();
    std::set<std::size_t> left;
    for (std::size_t i = 0; i < chosen.count(); ++i) left.insert(i);
    while (!left.empty()) {
      std::size_t best = *left.begin();
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t i : left) {
        known.push_back(more[i]);
        const auto after = error.after_each(known, known.size()).back();
        known.pop_back();
        if (after && *after < least) {
          least = *after;
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
    ForecastNoise noise = known_.fit().noise;
    noise.prior = options_.prior;
    return noise;
  }

  void forecast(const Configurations& chosen) {
    if (result_.places == 0) return;
    const std::size_t measured = known_.rows().size();
    const Forecast errors = forecast_with(chosen);
    for (std::size_t n = 0; n < errors.points.size(); ++n)
      (n <= measured ? result_.curve : result_.ahead).push_back(errors.points[n]);
    result_.expected = errors.stated[judged() ? measured : errors.stated.size() - 1];
    if (!known_.determined()) return;
    int ahead = std::min(poses_looked_ahead, int(candidates_.count()));
    if (spacing_ && !spacing_->most.empty())
      ahead = int(std::min<std::int64_t>(
          ahead, std::accumulate(spacing_->most.begin(), spacing_->most.end(), std::int64_t{0})));
    result_.with_three = forecast_with(search_for(parts_for("test_pose"), "test_pose", ahead)).points.back();
  }

  /// After 0, 1, … of the measured poses and these.
  struct Forecast {
    std::vector<std::optional<ExpectedError>> stated;
    std::vector<NextPoint> points;
  };

  Forecast forecast_with(const Configurations& more) const {
    const NextFit& fit = known_.fit();
    const int threads = study_.planner.threads;
    std::vector<PoseRows> all = known_.rows();
    for (PoseRows& row : rows_of(study_.first(), more, threads)) all.push_back(std::move(row));
    const ForecastOfError forecast(study_.first(), noise());
    const std::vector<Eigen::MatrixXd> covariances = forecast.covariance_after_each(all);
    ErrorsToExpect errors(candidates_, study_.first(), fit.poses, more, threads);
    if (judged()) errors.take_size_of(fit.residuals, covariances[fit.poses.size()]);
    Forecast result{errors.after_each(covariances), {}};
    const bool no_tip = std::none_of(result.stated.begin(), result.stated.end(), [](const auto& e) { return !!e; });
    const auto by_noise = no_tip ? forecast.after_each(all) : std::vector<std::optional<double>>();
    for (std::size_t n = 0; n < result.stated.size(); ++n) {
      std::optional<ExpectedError>& e = result.stated[n];
      NextPoint point{int(n)};
      if (e) {
        e->required = result_.required;
        if (!known_.places_stated()) e->at = ExpectedError::At::candidates;
        point.expected = e->usual().error;
      } else if (no_tip) {
        point.expected = by_noise[n];
      }
      result.points.push_back(point);
    }
    return result;
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

  /// Limits with whatever effect the residuals leave possible, and requirements against them.
  void fill_requirements() {
    const RequirementSpec& require = known_.fit().problem.design.require;
    if (!judged()) return;
    const std::vector<PossibleEffects> effects =
        possible_effects(*study_.first().model, study_.first().columns, known_.fit().poses);
    const ErrorLimits limits = error_limits(study_.first(), noise(), known_.fit().poses, effects, require.of_axes());
    result_.effect_below = limits.effect;
    if (!result_.curve.empty()) result_.curve.back().upper = limits.error;
    if (result_.required && !result_.curve.empty())
      result_.requirements.push_back(
          {"accuracy", "m", *result_.required, result_.curve.back().expected, result_.curve.back().upper});
    if (!require.of_axes() && require.sigma.empty()) return;
    const auto sigmas = ForecastOfError(study_.first(), noise()).sigmas(known_.rows(), require.of_axes());
    if (!sigmas) return;
    require_axes(require, *sigmas, limits);
    require_sigmas(require, *sigmas, limits);
  }

  void require_axes(const RequirementSpec& require, const ForecastSigmas& sigmas, const ErrorLimits& limits) {
    constexpr std::array<const char*, 6> names = {"position x", "position y", "position z",
                                                  "rotation x", "rotation y", "rotation z"};
    for (std::size_t k = 0; k < names.size(); ++k)
      if (require.axes[k])
        result_.requirements.push_back(
            {names[k], k < 3 ? "m" : "rad", *require.axes[k], sigmas.axes[k], limits.axes[k]});
  }

  void require_sigmas(const RequirementSpec& require, const ForecastSigmas& sigmas, const ErrorLimits& limits) {
    const VariantColumns& columns = study_.first().columns;
    const auto wanted = values_by_pattern(columns, require.sigma, known_.fit().problem, "the required σ");
    for (std::size_t j = 0; j < wanted.size(); ++j)
      if (wanted[j])
        result_.requirements.push_back({"sigma " + columns.parameters[j].name, columns.parameters[j].unit, *wanted[j],
                                        sigmas.parameters[Eigen::Index(j)], limits.parameters[Eigen::Index(j)]});
  }

  bool judged() const { return known_.determined() && known_.fit().fitted; }

  void judge() {
    if (!judged()) return;
    const auto& required = result_.requirements;
    const bool met = !required.empty() && std::all_of(required.begin(), required.end(),
                                                      [](const NextRequirement& one) { return one.met(); });
    if (met) {
      result_.verdict = NextVerdict::reached;
      return;
    }
    if (!required.empty()) result_.verdict = NextVerdict::go_on;
    if (result_.curve.empty() || !result_.curve.back().expected) return;
    const NextPoint& now = result_.curve.back();
    result_.verdict = NextVerdict::go_on;
    if (result_.with_three && result_.with_three->expected &&
        *result_.with_three->expected > (1 - least_gain) * *now.expected)
      result_.verdict = NextVerdict::flat;
  }

  const NextOptions& options_;
  const Monitor& monitor_;
  KnownSoFar known_;
  const Study& study_;
  Configurations candidates_;       ///< of the study, feasible at the estimated values
  std::optional<Spacing> spacing_;  ///< among them
  Eigen::MatrixXd information_;     ///< from before, on the columns of the search
  NextPoses result_;
};

}  // namespace

NextPoses next_poses(const Problem& problem, const NextOptions& options, const Monitor& monitor) {
  return NextRun(problem, options, monitor).run();
}

}  // namespace posewright
