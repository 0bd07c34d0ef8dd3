#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posewright/planning/configuration_space.hpp"
#include "posewright/search/search.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/study/pose_distance.hpp"
#include "posewright/study/setup.hpp"

namespace posewright {

struct Discrepancy;
/// A resolved problem with all that its candidates decide, made once: configurations to choose from, columns,
/// distances.
struct Study : Setup {
  Configurations configurations{};
  std::string list{};                                ///< that the candidates came from; empty: they were drawn
  std::vector<std::string> notes{};                  ///< on the reading of the lists
  PoseDistance distance{};                           ///< that poses keep from each other
  std::optional<Spacing> spacing{};                  ///< among the candidates; none: all may be chosen together
  std::shared_ptr<const Discrepancy> discrepancy{};  ///< of the first variant; null: no truth is named
  std::string why_criterion{};                       ///< sentence about a criterion that was chosen; empty: none was
};
/// Policy for a variant whose parameters cannot be identified: throw CannotDo, or keep it with the reason.
enum class Unidentifiable { refuse, keep };
/// Draws the candidates or takes them from the setup's list, and resolves what they decide.
Study make_study(Setup setup, const Monitor& monitor, Unidentifiable unidentifiable = Unidentifiable::refuse);
/// Overload for candidates that were drawn before from the first variant's workspace.
Study make_study(Setup setup, Configurations drawn, Unidentifiable unidentifiable = Unidentifiable::refuse);
/// Candidates of a setup without a list.
Configurations draw_candidates(const Setup& setup, const Monitor& monitor);

/// The one place where a criterion is chosen, by the number of poses (none: it is searched). Few poses: o1. From 1.5
/// times the smallest number on, for `auto`: bias, and o1 where bias has nothing to count; for a variant with
/// `unmodelled` and no criterion named: accuracy at the test poses (without any: at 200 candidates) of a fit that
/// estimates the effect, too. A criterion that needs test poses counts candidates if there are none, where resolve()
/// lets it.
/// @return the study with the criterion, its test poses and the reason
Study choose_criterion(Study study, const std::optional<int>& poses);

/// Request for a search of this number of poses, among blocks alone.
SearchRequest search_request(const Setup& setup, int poses);
/// Variant at the minimum distance between candidates; `study` must outlive the request.
SearchRequest spaced_request(const Study& study, int poses);

/// Raw blocks of the configurations for one variant alone, with the other inputs of a search.
std::vector<SearchPart> search_parts(const Variant& variant, const Configurations& configurations, int threads);
/// Overload for every variant of the criterion: with the effects of the truth if it needs one.
/// @param known  raw information from before, in place of the variants' prior; null: theirs
std::vector<SearchPart> search_parts(const Study& study, const std::string& criterion,
                                     const Configurations& configurations, int threads,
                                     const Eigen::MatrixXd* known = nullptr);
/// A copy of the parts of search_parts for every variant: a search moves its parts.
std::vector<SearchPart> copied_parts(const std::vector<SearchPart>& parts);

/// The workspace of the problem for searches beyond candidates; study, candidates and spacing must outlive the result.
std::function<std::unique_ptr<ConfigurationSpace>(const Eigen::MatrixXd& R)> space_maker(
    const Study& study, const std::string& criterion, const Configurations& candidates, const Configurations& known,
    const Spacing& spacing);
/// Overload for the candidates of the study, beside what is there before.
std::function<std::unique_ptr<ConfigurationSpace>(const Eigen::MatrixXd& R)> space_maker(const Study& study,
                                                                                         const std::string& criterion);

/// Existing poses: measured configurations, then fixed ones.
Configurations known_before(const Setup& setup);

/// The configurations that are measured already, then these.
Configurations with_measured(const Setup& setup, const Configurations& poses);

/// Result of a search: chosen candidates, and poses beyond them.
Configurations chosen_by(const Design& design, const Configurations& candidates);

/// The list without those of these indices.
Configurations without(const Configurations& list, const std::vector<int>& left_out);

/// One configuration more.
void append(Configurations& list, std::span<const double> q);
/// The i-th of `from` with its row.
void append(Configurations& list, const Configurations& from, std::size_t i);

}  // namespace posewright
