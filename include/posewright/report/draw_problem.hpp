#pragma once

#include <filesystem>

#include "posewright/problem/problem.hpp"
#include "posewright/report/report.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct DrawOptions {
  int evenly = 200;   ///< configurations drawn evenly within the limits, feasible or not
  int feasible = 40;  ///< feasible ones besides
  std::uint64_t seed = 0;
  int threads = 0;   ///< 0 = all
  bool ways = true;  ///< find out what is reachable from home, where the problem asks for it
};

/// True if a file is YAML and no parameters file.
bool is_problem(const std::filesystem::path& file);

/// The cell of a problem that has no plan yet: robot at home and at many configurations, each with the verdict of the
/// checks. What is wrong with cell or home becomes a fault; the picture then leaves out the check that fails.
/// Throws InputError where robot or instrument cannot be made, so that nothing can be drawn.
ProblemReport draw_problem(const Problem& problem, const DrawOptions& options, const Monitor& monitor);

}  // namespace posewright
