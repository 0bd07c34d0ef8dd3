#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/programs/program_document.hpp"

namespace posewright::programs {

/// Numbers that say which joints a pose has, in the order of PoseForm::status; the rest is zero.
using Status = std::array<long, 6>;

/// Written form of a pose in a language, and its joints.
struct PoseForm {
  std::vector<std::string> values;  ///< three of the position, then those of the orientation
  int turn_decimals = 5;
  Eigen::Isometry3d (*place)(const std::vector<double>& values) = nullptr;
  std::vector<double> (*written)(const Eigen::Isometry3d& X) = nullptr;

  std::vector<std::string> status;  ///< numbers that say which joints
  std::vector<long> masks{};        ///< bits of each that are of the six axes; 0: the whole number
  std::size_t required = 0;         ///< so many of them must be met; others decide between what is left
  /// At axes in deg; it changes only where one of them is at a multiple of 90 deg.
  Status (*status_of)(const ArmStand& stand, const std::array<double, 6>& axes) = nullptr;
  std::string (*status_text)(std::size_t which, long value) = nullptr;
  int length_decimals = 4;
  bool nearest = false;        ///< no status: the controller takes the joints nearest to those before the motion
  bool turns_open = false;     ///< the status leaves whole turns open: joints within ±180 deg are meant
  bool in_robot_base = false;  ///< of a pose whose base the program does not name

  /// The listed number with the bits of the six axes as they are now.
  long merged(std::size_t which, long listed, long now) const;
  bool meets(std::size_t which, double listed, long now) const;
};

const PoseForm& krl_pose();
const PoseForm& rapid_pose();
const PoseForm& tp_pose();
const PoseForm& urscript_pose();
const PoseForm& inform_pose();
const PoseForm& val3_pose();
/// Words of each status of VAL 3: of front, above and a positive fifth joint first.
const std::array<std::array<std::string_view, 2>, 3>& val3_status_words();

}  // namespace posewright::programs
