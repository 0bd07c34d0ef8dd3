#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/tasks/evaluate_problem.hpp"

namespace posewright {

/// Text for the terminal: scores by every criterion, each pose's share and the cost of its loss, drop and add.
std::string evaluation_text(const PoseListEvaluation& evaluation);

/// JSON: schema posewright/evaluation/1.
nlohmann::ordered_json evaluation_json(const PoseListEvaluation& evaluation);

}  // namespace posewright
