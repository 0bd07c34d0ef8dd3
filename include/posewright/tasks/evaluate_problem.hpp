#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/lists/pose_list.hpp"
#include "posewright/outputs/plan.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/tasks/plan_problem.hpp"

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

struct EvaluateOptions {
  RunOptions run;
  std::optional<int> drop, add;
};

/// The user's own list: scored by every criterion that the problem allows, its certificate against the candidates, the
/// contribution of each pose and the cost of its loss, which `drop` poses to leave out, which `add` to measure
/// more. Throws InputError for a list that holds infeasible poses, naming the constraint.
/// @param poses  read with pose_coordinates()
PoseListEvaluation evaluate_problem(const Problem& problem, const PoseList& poses, const EvaluateOptions& options,
                                    const Monitor& monitor);

}  // namespace posewright
