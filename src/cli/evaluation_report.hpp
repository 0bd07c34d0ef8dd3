#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/pipeline/evaluate_problem.hpp"

namespace posewright::cli {

/// What a person reads: scores by every criterion, each pose's share and what its loss costs, what to drop and add.
std::string evaluation_text(const PoseListEvaluation& evaluation);

/// The same for machines, schema posewright/evaluation/1.
nlohmann::ordered_json evaluation_json(const PoseListEvaluation& evaluation);

}  // namespace posewright::cli
