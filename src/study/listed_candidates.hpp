#pragma once

#include "posewright/study/study.hpp"

namespace posewright {

/// Makes the configurations of a user's list the candidates, each different one once, with the row where it stands.
///
/// A list with readings of the problem's instrument was measured: the robot was there, so limits and cell reject
/// nothing and a note says which poses they would. Any other list is still to be measured: what no variant's workspace
/// allows is rejected, counted by its reason and named in a note; a hair beyond a limit is the limit.
/// @param study  with its variants and a list
/// Throws CannotDo if nothing is left.
void take_listed_candidates(Study& study);

}  // namespace posewright
