#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "posewright/outputs/plan.hpp"
#include "posewright/pipeline/pose_list.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// What a command line may say over the problem file's design block.
struct PlanOptions {
  std::string variant, criterion, method;  ///< empty = as in the file
  std::string truth;                       ///< the variant that may be the case; empty = as in the file
  std::optional<int> poses, candidates, restarts;
  bool smallest = false;  ///< the smallest number of poses that reaches design: require
  std::optional<Repeats> repeats;
  std::optional<Scaling> scaling;
  std::optional<bool> prior;  ///< count tolerances as prior knowledge
  bool reserve = false;       ///< maximise what is left when the pose that hurts most is lost
  PoseSource measured;        ///< poses that are measured already; empty = as in the file
  /// Candidates, in place of drawn ones; empty = as in the file, unless `candidates` says how many to draw.
  PoseSource candidates_from{};
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0 = all
};

/// Problem → model → candidates → blocks → search → plan. Reproducible for the same problem, options and version,
/// whatever the number of threads, as long as the monitor does not stop it. Throws InputError and CannotDo as the
/// stages do; CannotDo naming the shortfall where there are fewer poses than the parameters need.
Plan plan_problem(const Problem& problem, const PlanOptions& options, const Monitor& monitor);

/// Poses to judge the plan's calibration by, which are not fitted: those where its calibrated model is least certain
/// and so can be most wrong (what they add to log det of the information); where a truth is named, those that tell it
/// from the fitted variant best (criterion discriminate). The plan's own poses are in the result as measured.
/// @param options  those the plan was made with
/// @param poses    how many, > 0
Plan plan_validation(const Problem& problem, PlanOptions options, const Plan& plan, int poses, const Monitor& monitor);

}  // namespace posewright
