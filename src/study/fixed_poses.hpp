#pragma once

#include "posewright/lists/pose_list.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/repeats.hpp"

namespace posewright {

/// Puts the poses of a list that take_fixed() took up into study.fixed. They are still to be measured, so every
/// variant's workspace must allow them; the minimum distance is not asked of them.
/// @param study  with its variants and measured poses
/// Throws InputError with file and line for a pose that is forbidden, and for one that is fixed or measured twice if
/// repeats are forbidden.
void fix_poses(Study& study, const PoseList& list, Repeats repeats);

}  // namespace posewright
