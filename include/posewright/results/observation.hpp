#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/criterion/observability_indices.hpp"
#include "posewright/planning/practical_identifiability.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

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

/// Text for the terminal of one variant: rank, spectrum, dependencies, parameters worth identifying.
/// @param with_singular_values  of G too
std::string observation_text(const Observation& observation, bool with_singular_values = false);

/// Complete JSON.
nlohmann::ordered_json observation_json(const Observation& observation);
/// All observed variants of a problem: schema posewright/observation/1.
nlohmann::ordered_json observations_json(const Problem& problem, std::uint64_t seed,
                                         const std::vector<Observation>& observations);

}  // namespace posewright
