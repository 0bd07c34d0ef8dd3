#pragma once

#include <string>
#include <vector>

#include "posewright/problem/robot_specs.hpp"

namespace posewright {

/// Links between which an arm would be calibrated if nobody says it.
struct ProposedChain {
  std::string base;  ///< parent of the first moving joint
  std::string tip;
  std::vector<std::string> other_tips;  ///< links behind the last joint of the arm that would do as well
};

/// The tip is the link that is called as a flange (tool0, flange, ee_link, tool_frame, tcp, alone or after an
/// underscore), the first of these names that one link bears. Where there is none, the way from the root is followed to
/// where it forks into branches that move (a gripper's fingers), or to its end.
/// @param base, tip  links that are given already; empty: to be found
/// Throws InputError for a file that is no URDF, a link that is not there, a robot of which nothing moves, and one that
/// forks before anything moves (two arms, a base with wheels): then the message lists its ends.
ProposedChain propose_chain(const SerialArmSpec& arm, const std::string& base, const std::string& tip);

}  // namespace posewright
