#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/criterion/observability_indices.hpp"
#include "posewright/planning/practical_identifiability.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct ObserveOptions {
  std::string variant;       ///< empty = all variants
  int candidates = 2000;     ///< configurations in the pool
  std::optional<int> poses;  ///< for predicted σ; default: design: poses, at least the smallest number
  std::uint64_t seed = 0;
  int threads = 0;
};

/// Parameters of one variant that a set of configurations can identify.
struct Observation {
  std::string variant;
  std::size_t configurations = 0;
  int rows = 0;                                 ///< of one block
  std::vector<Parameter> parameters;            ///< all free columns, nuisance first
  Identifiability identifiability;              ///< over those columns
  std::vector<std::vector<std::string>> given;  ///< of each of `parameters`: posewright::given()
  int exact_rank = 0;                           ///< rank where only dependencies to rounding count
  ObservabilityIndices indices;       ///< of the kept interest columns, nuisance eliminated, scaled by tolerance
  std::vector<Parameter> kept;        ///< labels of the independent columns, in their order
  std::optional<int> smallest_poses;  ///< that determine them; none if the pool does not suffice
  std::optional<PracticalIdentifiability> practical;  ///< over `kept`; none if the pool leaves them singular
};

/// Per variant: rank, scaled singular values, indices of the pool, dependencies, parameters worth identifying, the
/// smallest number of poses.
std::vector<Observation> observe_problem(const Problem& problem, const ObserveOptions& options, const Monitor& monitor);

}  // namespace posewright
