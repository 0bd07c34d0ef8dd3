#pragma once

#include <vector>

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// A design whose poses have left the candidates.
struct PoseSet {
  std::vector<std::vector<double>> configurations;
  std::vector<int> candidates;  ///< −1: no candidate any more
  BlockArray blocks;            ///< one a pose
  double value = 0.0;           ///< Φ
};
/// Φ of these blocks and what is known before.
double value_of_blocks(const DesignTask& task, const BlockArray& blocks);
PoseSet pose_set_of(const DesignTask& task, const std::vector<int>& members);
/// As a design: poses that moved are `added`.
void write_to(Design& design, const PoseSet& poses, std::size_t candidates);

/// Moves the poses themselves: a few at once, each to a local maximum of Φ with the others fixed, until a round gains
/// nothing; where the feasible set is a box, then all at once by MMA. Never leaves the feasible set, never returns less
/// than it got, keeps poses apart where they may not repeat. Returns the number of moves accepted.
/// @param threads  0: all; the result is the same for any number
long improve(const DesignTask& task, PoseSet& poses, int threads, const Monitor& monitor);
/// The first rounds of it, each pose in turn: enough to tell which of several sets is worth the rest.
long improve_roughly(const DesignTask& task, PoseSet& poses, const Monitor& monitor);

}  // namespace posewright
