#pragma once

#include <optional>
#include <vector>

#include "posewright/lists/pose_list.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/route.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// The list without the poses that its route lost, and as many new ones: those that add most to the rest, of candidates
/// that a free motion connects with home. New ids follow the largest one of the list.
/// @param replaced  earlier replacements; those of this call are added
/// Throws CannotDo where no candidate can be reached.
PoseList with_replacements(const Problem& problem, const PoseList& list, const Route& route, std::uint64_t seed,
                           const Monitor& monitor, std::vector<SkippedPose>& replaced);

/// A replacement that is lost itself leaves the pose of the plan unreachable.
void settle_replaced(Route& route);

/// Efficiency of a route's poses against the whole plan; none if they do not identify all parameters.
/// @param plan    all poses, with those that are measured already marked
/// @param routed  the list that the route was made of: the plan, or one with replacements
std::optional<RouteWorth> worth_of_route(const Problem& problem, const PoseList& plan, const PoseList& routed,
                                         const Route& route, const Monitor& monitor);

}  // namespace posewright
