#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "posewright/results/observation.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct ObserveOptions {
  std::string variant;       ///< empty = all variants
  int candidates = 2000;     ///< configurations in the pool
  std::optional<int> poses;  ///< for predicted σ; default: design: poses, at least the smallest number
  std::uint64_t seed = 0;
  int threads = 0;
};

/// Per variant: rank, scaled singular values, indices of the pool, dependencies, parameters worth identifying, the
/// smallest number of poses.
std::vector<Observation> observe_problem(const Problem& problem, const ObserveOptions& options, const Monitor& monitor);

}  // namespace posewright
