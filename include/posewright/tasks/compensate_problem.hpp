#pragma once

#include <vector>

#include "posewright/lists/pose_list.hpp"
#include "posewright/model/arm_inverse.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/compensation.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct CompensateOptions {
  CommandSolver::Options solver{};
  /// True if listed poses include the deflection of the nominal springs under the load; else they are where its
  /// controller takes it to stand, which knows of no springs.
  bool elastic_target = false;
  int threads = 0;  ///< never changes a result
};

/// Coordinates that lists are read with: limits of robot and controller, not those of the workspace that is measured.
/// @param problem  with parameters (apply_parameters())
/// Throws CannotDo for a robot that carries no tip.
std::vector<Coordinate> compensation_coordinates(const Problem& problem);

/// Inverse kinematics of the nominal arm. Throws CannotDo for other kinds of robots.
ArmInverse nominal_inverse(const Problem& problem);

/// Looks at points between the ends of straight motions: the nominal robot moves the tool along the line between the
/// poses that are commanded; `lines` of the result is how far the calibrated one leaves the line between those that
/// were meant.
void check_lines(const Problem& problem, const CompensateOptions& options, Compensation& result);

/// Commands for the robot of a problem with parameters (apply_parameters()), so that it stands where the nominal one
/// would. Poses are independent of each other: any number of threads has the same result.
/// Throws CannotDo for a robot of fewer than six axes (unless for positions only) and where it is stopped, InputError
/// for lists of another robot and for a joint with listed compliances between its positions.
Compensation compensate_problem(const Problem& problem, const std::vector<PoseList>& lists,
                                const CompensateOptions& options, const Monitor& monitor);

}  // namespace posewright
