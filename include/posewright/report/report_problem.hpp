#pragma once

#include <filesystem>

#include "posewright/problem/problem.hpp"
#include "posewright/report/report.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct ReportOptions {
  std::filesystem::path route;  ///< route.json of the same plan; empty: poses in the plan's order, no motions
  /// Search for what other numbers of poses reach where the plan does not state it.
  bool sizes = true;
  bool candidates = true;  ///< draw the plan's candidates again to show the gain of each
  int threads = 0;         ///< 0 = all
};

/// Data of a report on a plan of this problem: recomputed from the written poses and, for candidates and
/// numbers of poses that the plan does not state, from the problem and the plan's seed. Where the monitor says stop,
/// the curve ends there. Throws InputError for a plan or route that does not fit the problem.
Report report_problem(const Problem& problem, const std::filesystem::path& plan, const ReportOptions& options,
                      const Monitor& monitor);

}  // namespace posewright
