#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "posewright/results/plan.hpp"

namespace posewright {

/// One criterion of a user's poses.
struct CriterionScore {
  std::string name;
  double value = 0.0;                ///< in its own terms (docs/plan-file.md)
  std::optional<double> efficiency;  ///< lower bound against the best plan of as many candidates; none: no bound
};

/// A change of the list and its effect.
struct ListChange {
  std::vector<int> poses;          ///< ids to drop, 1 = the first of the list; empty if poses are added
  std::vector<PlannedPose> added;  ///< poses to add
  double efficiency = 0.0;         ///< of the changed list relative to the list as it is, by the criterion
  double log_det = 0.0;            ///< of the changed list
  std::optional<double> rho0;      ///< m
};

struct PoseListEvaluation {
  Plan plan;  ///< the list as a plan: log det, σ, accuracy, contributions, certificate of the criterion
  std::vector<CriterionScore> scores;
  std::optional<ListChange> drop, add;
  std::vector<std::string> notes{};  ///< on how the list was read
};

/// Text for the terminal: scores by every criterion, each pose's share and the cost of its loss, drop and add.
std::string evaluation_text(const PoseListEvaluation& evaluation);

/// JSON: schema posewright/evaluation/1.
nlohmann::ordered_json evaluation_json(const PoseListEvaluation& evaluation);

}  // namespace posewright
