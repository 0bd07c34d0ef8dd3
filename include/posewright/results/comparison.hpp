#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/tasks/compare_problem.hpp"

namespace posewright {

/// What a person reads: variants × plans, aliases, whether more parameters pay.
/// @param aliases_in_full  every parameter of every alias, not one line for each
std::string comparison_text(const Comparison& comparison, bool aliases_in_full);

/// The same for machines, nothing left out: schema posewright/comparison/1.
nlohmann::ordered_json comparison_json(const Problem& problem, const CompareOptions& options,
                                       const Comparison& comparison);

/// "matrix over rigid: worth …": one sentence that says on what it rests.
std::string worth_text(const ExtraWorth& worth);

}  // namespace posewright
