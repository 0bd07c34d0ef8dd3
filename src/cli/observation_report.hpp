#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/pipeline/observe_problem.hpp"

namespace posewright::cli {

/// What a person reads of one variant: rank, spectrum, dependencies, what is worth identifying.
std::string observation_text(const Observation& observation);

/// The same for machines, nothing left out.
nlohmann::ordered_json observation_json(const Observation& observation);

}  // namespace posewright::cli
