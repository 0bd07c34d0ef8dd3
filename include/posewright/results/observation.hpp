#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "posewright/tasks/observe_problem.hpp"

namespace posewright {

/// Text for the terminal of one variant: rank, spectrum, dependencies, parameters worth identifying.
/// @param with_singular_values  of G too
std::string observation_text(const Observation& observation, bool with_singular_values = false);

/// Complete JSON.
nlohmann::ordered_json observation_json(const Observation& observation);
/// All observed variants of a problem: schema posewright/observation/1.
nlohmann::ordered_json observations_json(const Problem& problem, const ObserveOptions& options,
                                         const std::vector<Observation>& observations);

}  // namespace posewright
