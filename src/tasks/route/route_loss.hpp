#pragma once

#include <optional>

#include "posewright/lists/pose_list.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/route.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Efficiency of a route's poses against the whole plan; none if they do not identify all parameters.
/// @param plan    all poses, with those that are measured already marked
/// @param routed  the list that the route was made of: the plan, or one with replacements
std::optional<RouteWorth> worth_of_route(const Problem& problem, const PoseList& plan, const PoseList& routed,
                                         const Route& route, const Monitor& monitor);

}  // namespace posewright
