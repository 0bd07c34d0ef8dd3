#pragma once

#include <optional>

#include "posewright/lists/pose_list.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/evaluation.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/tasks/plan_problem.hpp"

namespace posewright {

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
