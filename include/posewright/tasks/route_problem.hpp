#pragma once

#include <filesystem>
#include <optional>

#include "posewright/lists/pose_list.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/route.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct RouteOptions {
  bool from_home = false;                 ///< begins at home
  bool closed = false;                    ///< ends where it began
  std::optional<int> start;               ///< pose id to begin with
  bool replace = false;                   ///< lost poses by the next best ones that can be reached
  int milestones = 200;                   ///< of the roadmap, built where a straight motion is not free
  std::optional<double> settle, reading;  ///< s, in place of the problem's motion.settle and motion.reading
  std::uint64_t seed = 0;
  int threads = 0;
};

/// The problem file that a plan was made for, as the plan names it or beside the plan. Throws InputError if it is
/// not found or the plan is none.
std::filesystem::path problem_of_plan(const std::filesystem::path& plan);

/// Order and motions for the poses of a plan (or CSV list) of this problem. Motions are looked for only where they are
/// needed: a tour of the shortest conceivable motions is found, its motions are made, and so on until all motions of
/// the tour are real; where the tour is optimal for these times, no other order is shorter. If the search is stopped,
/// the best order so far is returned. A joint with several turns moves to the turn nearest to home, if neither readings
/// nor parameters change with it. Where poses are left out or replaced, it reports the efficiency of the others. Throws
/// InputError for a list that does not fit, CannotDo if home is asked for and not free, if no pose can be reached, and
/// if the search is stopped before there is an order with all its motions.
/// @param poses  read with pose_coordinates()
Route route_problem(const Problem& problem, const PoseList& poses, const RouteOptions& options, const Monitor& monitor);

}  // namespace posewright
