#pragma once

#include "posewright/problem/problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/run_options.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Problem → model → candidates → blocks → search → plan. Reproducible for the same problem, options and version,
/// whatever the number of threads, as long as the monitor does not stop it. Throws InputError and CannotDo as the
/// stages do; CannotDo naming the shortfall if there are fewer poses than the parameters need.
Plan plan_problem(const Problem& problem, const RunOptions& run, const Monitor& monitor);

/// Poses to judge the plan's calibration by, which are not fitted: those where its calibrated model is least certain
/// and so can be most wrong (what they add to log det of the information); if a truth is named, those that tell it
/// from the fitted variant best (criterion discriminate). The plan's own poses are in the result as measured.
/// @param problem, run  those the plan was made with
/// @param poses         how many, > 0
Plan plan_validation(Problem problem, RunOptions run, const Plan& plan, int poses, const Monitor& monitor);

}  // namespace posewright
