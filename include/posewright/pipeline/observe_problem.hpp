#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/criterion/observability_indices.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct ObserveOptions {
  std::string variant;    ///< empty = all variants
  int candidates = 2000;  ///< configurations in the pool
  std::uint64_t seed = 0;
  int threads = 0;
};

/// What a pool of configurations can tell about one variant.
struct Observation {
  std::string variant;
  std::size_t configurations = 0;
  int rows = 0;                       ///< of one block
  std::vector<Parameter> parameters;  ///< all free columns, nuisance first
  Identifiability identifiability;    ///< over those columns
  int exact_rank = 0;                 ///< rank where only dependencies to rounding count
  ObservabilityIndices indices;       ///< of the kept interest columns, nuisance eliminated, scaled by tolerance
};

/// Per variant: rank, scaled singular values, indices of the pool, dependencies.
std::vector<Observation> observe_problem(const Problem& problem, const ObserveOptions& options, const Monitor& monitor);

}  // namespace posewright
