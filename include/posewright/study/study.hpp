#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/planning/configuration_space.hpp"
#include "posewright/search/search.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/study/run_options.hpp"
#include "posewright/study/spacing.hpp"
#include "posewright/study/variant.hpp"

namespace posewright {

/// The problem's design and the options of a run.
struct Settings {
  std::string criterion, method;
  bool criterion_automatic = false;  ///< criterion: auto; `criterion` is o1 until choose_criterion() takes another
  int poses = 0;                     ///< 0: the smallest number that suffices
  int candidates = 0;
  bool prior = false, reserve = false;
  Repeats repeats;
  Scaling scaling = Scaling::tolerance;
  std::vector<DesignSpec::Weighted> variants;  ///< at least one
  Located<std::string> truth;                  ///< the variant that may be the case; empty: none
  std::optional<PoseList> measured;
  std::optional<PoseList> candidates_from;  ///< none: candidates are drawn
  std::optional<Configurations> drawn{};    ///< candidates that were drawn before; none: they are drawn now
  /// Names of files to read; empty: none.
  std::filesystem::path measured_file, candidates_file;
  std::optional<PoseList> fixed{};  ///< poses that are in any plan; only what plans a whole list asks for them
  PlannerOptions planner;
  bool candidates_alone = false, everything_counts = false;  ///< as RunOptions
  std::shared_ptr<const Cell> same_robot{};                  ///< the same
  ProofLimits proof{};
  std::optional<RobustSpec> robust{};  ///< only what plans or judges a whole list asks for drawn robots
};
/// Throws InputError for contradictions, with their line.
Settings settings_of(const Problem& problem, const RunOptions& run);
/// Throws InputError where the design has no number of poses, or auto without all that it needs.
void require_number_of_poses(const Problem& problem);

/// Takes up the poses that are fixed by the run or the problem, for what plans a whole list; what judges a given
/// one does without. Of a list that marks poses as fixed, those. Throws InputError with file and line if none is left
/// to be chosen beside them, and for `reserve`: what is fixed may be lost, too.
/// @return notes on the reading of the list
std::vector<std::string> take_fixed(const Problem& problem, const RunOptions& run, Settings& settings);

/// Takes up whether robots are to be drawn. Throws InputError for what that does not go together with.
void take_robust(const Problem& problem, Settings& settings);

struct Discrepancy;
struct Study;
/// A problem with all that its names mean, made first and once: variants in their cell, feasible configurations, poses
/// that are there already.
struct Study {
  std::shared_ptr<const Cell> cell;
  std::vector<Variant> variants;
  Configurations configurations;
  std::string list;                ///< that the candidates came from; empty: they were drawn
  std::vector<std::string> notes;  ///< of how it was read
  Configurations measured;
  Configurations fixed;  ///< still to be measured, in any plan: known to the search beside the measured ones
  PoseDistance distance;
  Spacing minimum_distance;                        ///< with the candidates' points, where a distance is kept
  std::shared_ptr<const Discrepancy> discrepancy;  ///< of the first variant; null: no truth is named

  Variant& first() { return variants.front(); }
  const Variant& first() const { return variants.front(); }
};
/// Policy for a variant whose parameters cannot be identified: throw CannotDo, or keep it with the reason.
enum class Unidentifiable { refuse, keep };
Study make_study(const Problem& problem, const Settings& settings, const Monitor& monitor,
                 Unidentifiable unidentifiable = Unidentifiable::refuse);

/// The one place where a criterion is chosen, by the number of poses. Few poses: o1. From 1.5 times the smallest number
/// on, for `auto`: bias, and o1 where bias has nothing to count; for a variant with `unmodelled` and no criterion
/// named: accuracy at the test poses (without any: at 200 candidates) of a fit that estimates the effect, too. A
/// criterion that needs test poses counts candidates if there are none, where settings_of() lets it.
/// @return which and why, for messages; empty: nothing was chosen
std::string choose_criterion(const Problem& problem, Study& study, Settings& settings);

/// Columns of an assumed effect make each candidate several times as costly: fewer starts, and no moves between
/// candidates, where nobody stated them.
void limit_search_with_effect(const DesignSpec& design, Settings& settings);

/// Request for a search of this number of poses, among blocks alone.
SearchRequest search_request(const Settings& settings, int poses);
/// Variant at the minimum distance between candidates; `study` must outlive the request.
SearchRequest spaced_request(const Study& study, const Settings& settings, int poses);

/// Raw blocks of the configurations for one variant alone, with the other inputs of a search.
std::vector<SearchPart> search_parts(const Variant& variant, const Configurations& configurations, int threads);
/// Variant for every variant of the criterion: with the effects of the truth if it needs one.
std::vector<SearchPart> search_parts(const Study& study, const std::string& criterion,
                                     const Configurations& configurations, int threads);
/// A copy of the parts of search_parts for every variant: a search moves its parts.
std::vector<SearchPart> copied_parts(const std::vector<SearchPart>& parts);

/// The workspace of the problem for searches beyond candidates; study, candidates and spacing must outlive the result.
std::function<std::unique_ptr<ConfigurationSpace>(const Eigen::MatrixXd& R)> space_maker(
    const Study& study, const std::string& criterion, const Configurations& candidates, const Configurations& known,
    const Spacing& spacing);
/// Overload for the candidates of the study, beside what is there before.
std::function<std::unique_ptr<ConfigurationSpace>(const Eigen::MatrixXd& R)> space_maker(const Study& study,
                                                                                         const std::string& criterion);

/// Takes away candidates that repeat a measured or fixed pose or are nearer to one than the minimum distance, where the
/// policy forbids it; rebuilds all that depends on the candidates. Throws CannotDo if none is left.
void keep_away_from_measured(Study& study, Repeats repeats);

/// Existing poses: measured configurations, then fixed ones.
Configurations known_before(const Study& study);

/// The configurations that are measured already, then these.
Configurations with_measured(const Study& study, const Configurations& poses);

/// Result of a search: chosen candidates, and poses beyond them.
Configurations chosen_by(const Design& design, const Configurations& candidates);

/// The list without those of these indices.
Configurations without(const Configurations& list, const std::vector<int>& left_out);

/// One configuration more.
void append(Configurations& list, std::span<const double> q);
/// The i-th of `from` with its row.
void append(Configurations& list, const Configurations& from, std::size_t i);

}  // namespace posewright
