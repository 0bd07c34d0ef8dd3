#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/results/stations.hpp"
#include "posewright/tasks/plan_problem.hpp"

namespace posewright {

struct StationOptions {
  RunOptions run;
  std::optional<int> choose;  ///< number of stations; else the problem's
  int full = 3;               ///< how many of the best are planned in full
  bool every_set = false;     ///< every set of so many stations is tried, however many there are
};

/// Criterion that places are compared by: `auto` is o1, whose differences are ratios of σ.
std::string criterion_of_places(const Problem& problem);

/// Chooses among the places of workspace.stations: a quick plan from each, full ones from the best. All sets of so many
/// stations are tried if they are at most 100 or all are asked for; else the best one gets the best second, and so on.
/// Best first. If the search is stopped, what is known by then is ranked, and the rest is marked. Throws InputError if
/// the problem names no places or its instrument has no stations, CannotDo if none of them gives a plan, and if the
/// search is stopped before a place is known, or before all but the last of several stations.
std::vector<StationRank> place_stations(const Problem& problem, const StationOptions& options, const Monitor& monitor);

}  // namespace posewright
