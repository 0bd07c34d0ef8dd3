#pragma once

#include "posewright/results/plan.hpp"
#include "posewright/search/search.hpp"
#include "posewright/study/study.hpp"

namespace posewright {

/// Searches for the plan that is best over robots drawn from the tolerances, among the candidates and the poses that
/// the nominal search found between them. `found` then holds that plan.
RobustPlan plan_robust(const Study& study, SearchResult& found, const Monitor& monitor);

/// Efficiency of a list of poses on the same robots, against plans of these candidates.
/// @param list  by index among the candidates
RobustPlan judge_robust_list(const Study& study, const Configurations& candidates, const std::vector<int>& list,
                             const Monitor& monitor);

}  // namespace posewright
