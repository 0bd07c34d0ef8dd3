#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "posewright/programs/program_document.hpp"

namespace posewright::programs {

/// Numbers that say which joints a pose has, in the order of PoseForm::status; the rest is zero.
using Status = std::array<long, 6>;

/// Written form of a pose in a language, and its joints.
struct PoseForm {
  std::vector<std::string> values;  ///< three in mm, then those of the orientation, deg unless they are a quaternion
  int turn_decimals = 5;
  Eigen::Isometry3d (*place)(const std::vector<double>& values) = nullptr;
  std::vector<double> (*written)(const Eigen::Isometry3d& X) = nullptr;

  std::vector<std::string> status;  ///< numbers that say which joints
  std::vector<long> masks{};        ///< bits of each that are of the six axes; 0: the whole number
  std::size_t required = 0;         ///< so many of them must be met; others decide between what is left
  /// At axes in deg; it changes only where one of them is at a multiple of 90 deg.
  Status (*status_of)(const ArmStand& stand, const std::array<double, 6>& axes) = nullptr;
  std::string (*status_text)(std::size_t which, long value) = nullptr;

  /// The listed number with the bits of the six axes as they are now.
  long merged(std::size_t which, long listed, long now) const;
  bool meets(std::size_t which, double listed, long now) const;
};

const PoseForm& krl_pose();
const PoseForm& rapid_pose();
const PoseForm& tp_pose();

}  // namespace posewright::programs
