#pragma once

#include <string>
#include <vector>

#include "posewright/criterion/criterion_data.hpp"
#include "posewright/outputs/plan.hpp"
#include "posewright/planning/design_task.hpp"
#include "posewright/planning/evaluate.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// The part of planning that is the same for a robot's blocks and for a user's.
struct SearchRequest {
  std::string criterion, method;
  int poses = 0;
  int nuisance = 0;
  Repeats repeats = Repeats::forbid;
  PlannerOptions planner;
  Eigen::VectorXd scale{};  ///< unit of every column for criteria that depend on it, raw units
  std::vector<TestPoint> test_points{};
  Eigen::VectorXd prior_sigma{};  ///< 1σ known before of every column, raw units; empty: nothing
};

struct SearchResult {
  Design design;
  BlockArray chosen;        ///< raw blocks of the design's members, in their order
  Certificate certificate;  ///< efficiency still to be filled from an evaluation, see certify()
  bool stopped = false;
};

/// Throws InputError where no criterion or planner has that name. `place` is where the name was written.
void require_known(const std::string& criterion, const std::string& method, const SourcePlace& criterion_place,
                   const SourcePlace& method_place);

/// Whitens `blocks` in place, solves for the bound, searches. Memory: the blocks and a few vectors of their number.
SearchResult search(BlockArray blocks, const SearchRequest& request, const Monitor& monitor);

/// The criterion in its own terms (docs/plan-file.md), from the evaluation of the written poses and the plan's test
/// errors.
double criterion_value(const Plan& plan, const Evaluation& evaluation, const SearchRequest& request);

/// Efficiency of a plan of this log det against the bound; the last step so that it rests on the evaluation's number.
void certify(Certificate& certificate, double log_det, int interest);

}  // namespace posewright
