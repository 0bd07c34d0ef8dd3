#pragma once

#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// The chain from base to tip of a URDF file, by the link that both hang on: a joint on the way up is passed from its
/// child to its parent, about its axis backward. Fixed joints are merged; continuous joints get ±π; a
/// mimic joint follows its master; a master outside the chain is a coordinate, too, whose offset and gear are those of
/// the first joint that follows it.
/// @param place  where the problem file names the robot, for errors about base and tip
/// Throws InputError with the URDF's file and, where it can be told, line: unreadable or malformed file, no such link,
/// floating or planar joints, limits that are missing, empty or not finite, a zero axis, no moving
/// joint; for an arm with several ways.
ChainDescription read_urdf_chain(const SerialArmSpec& arm, const SourcePlace& place);

}  // namespace posewright
