#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/tasks/compare_problem.hpp"

namespace posewright {

/// Text for the terminal: variants × plans, aliases, value of more parameters.
/// @param aliases_in_full  every parameter of every alias, not one line for each
std::string comparison_text(const Comparison& comparison, bool aliases_in_full);

/// Complete JSON: schema posewright/comparison/1.
nlohmann::ordered_json comparison_json(const Problem& problem, const CompareOptions& options,
                                       const Comparison& comparison);

/// "matrix over rigid: worth …": one sentence with its reason.
std::string worth_text(const ExtraWorth& worth);

}  // namespace posewright
