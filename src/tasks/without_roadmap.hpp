#pragma once

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Problem without the roadmap behind `reachable`, for code that finds reachable poses itself, or
/// only compares.
inline Problem without_roadmap(Problem problem) {
  problem.workspace.motion.reachable = false;
  return problem;
}

}  // namespace posewright
