#pragma once

#include "posewright/problem/problem.hpp"

namespace posewright {

/// The same problem without the roadmap behind `reachable`: for what finds out by itself which poses can be reached, or
/// only compares.
inline Problem without_roadmap(Problem problem) {
  problem.workspace.motion.reachable = false;
  return problem;
}

}  // namespace posewright
