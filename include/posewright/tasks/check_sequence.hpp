#pragma once

#include "posewright/formats/pose_sequence.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Asks of everything that a program made from the sequence would let the robot do whether this robot can: the names
/// and units of its coordinates, its limits and coupled limits at every pose, via point and home, the travel of its
/// actuators, and for routes that no motion is faster than its velocities. A file may have been edited since it was
/// written.
/// Returns the sequence with the robot's velocities.
/// Throws InputError naming the file, the pose and the coordinate, and the allowed values.
PoseSequence checked_sequence(const Problem& problem, PoseSequence sequence);

}  // namespace posewright
