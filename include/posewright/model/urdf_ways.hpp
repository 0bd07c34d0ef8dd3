#pragma once

#include <string>
#include <vector>

#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// The chain of one way of an arm with several.
struct WayChain {
  WaySpec way;
  ChainDescription chain;
  std::vector<std::size_t> coordinates;  ///< of each coordinate of the chain: its index among all
};

/// All ways of an arm, in their order, and what their joints have together: each joint once, where the first way has
/// it.
struct WayChains {
  std::vector<WayChain> ways;
  std::vector<Coordinate> coordinates;
};

/// The same arm with that way alone, from base to tip. Where a tip carries the measurement frame, that is the frame of
/// its link.
SerialArmSpec arm_of_way(const SerialArmSpec& arm, const WaySpec& way);

/// Index of an instrument's way among those of the arm.
std::size_t way_of(const SerialArmSpec& arm, const MeasurementSpec& instrument);

/// Throws as read_urdf_chain, and InputError where a joint follows one that only another way has.
WayChains read_urdf_ways(const SerialArmSpec& arm, const SourcePlace& place);

/// Frames of the joints that move on any of the ways, each on that of the joint above it, from the URDF's root on.
struct UrdfFrames {
  struct Tip {
    std::string name;
    int frame = 0;
    Eigen::Isometry3d X_FrameTip = Eigen::Isometry3d::Identity();
  };
  std::string robot;               ///< as its URDF calls it
  std::vector<ChainJoint> joints;  ///< in the sense of the URDF, parents first; the k-th moves frame k + 1
  std::vector<int> parents;        ///< frame that carries the joint; 0: the root
  std::vector<Coordinate> coordinates;
  std::vector<Tip> tips;  ///< of all ways, each once
  Tip base;               ///< measurement frame of ways that begin in no tip
};
UrdfFrames read_urdf_frames(const SerialArmSpec& arm, const SourcePlace& place);

}  // namespace posewright
