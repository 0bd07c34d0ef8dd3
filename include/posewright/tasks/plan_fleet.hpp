#pragma once

#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "posewright/tasks/plan_problem.hpp"

namespace posewright {

/// The plan of one robot of a fleet.
struct FleetPlan {
  std::string why_not;  ///< why there is none; empty: there is one
  std::string variant;
  int poses = 0;
  double log_det = 0.0;
  std::optional<double> efficiency;  ///< at least, of the best plan of its candidates; none: no bound
  std::optional<ExpectedError> expected{};
  double seconds = 0.0;
  std::string rendered;  ///< result of `render`

  static auto fields(auto& own) {
    return std::tie(own.why_not, own.variant, own.poses, own.log_det, own.efficiency, own.expected, own.seconds,
                    own.rendered);
  }
};

/// Plans every problem by itself, each in one process with all its threads (run_tasks).
/// @param render  converts a plan for its caller: files
std::vector<FleetPlan> plan_fleet(const std::vector<Problem>& problems, const RunOptions& run,
                                  const std::function<std::string(const Plan&, std::size_t index)>& render,
                                  const Monitor& monitor);

}  // namespace posewright
