#pragma once

#include "posewright/study/setup.hpp"

namespace posewright {

/// Puts a list into setup.fixed, of a list that marks poses as fixed those alone; does nothing for an empty list. They
/// are still to be measured, so every variant's workspace must allow them; the minimum distance is not asked of them.
/// @param setup  with its variants and measured poses
/// Throws InputError with file and line if none is left to be chosen beside them, for `reserve` (a fixed pose may be
/// lost, too), for a pose that is forbidden, and for one that is fixed or measured twice if repeats are forbidden.
void fix_poses(Setup& setup, const PoseList& list);

}  // namespace posewright
