#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/tasks/evaluate_problem.hpp"

namespace posewright {

/// What a person reads: scores by every criterion, each pose's share and what its loss costs, what to drop and add.
std::string evaluation_text(const PoseListEvaluation& evaluation);

/// The same for machines, schema posewright/evaluation/1.
nlohmann::ordered_json evaluation_json(const PoseListEvaluation& evaluation);

}  // namespace posewright
