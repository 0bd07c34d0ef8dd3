#pragma once

#include <string>
#include <vector>

namespace posewright {

/// Names of axes in programs: six that turn, then the external ones, in the order of the controller.
const std::vector<std::string>& krl_axis_names();
const std::vector<std::string>& rapid_axis_names();
/// E1 to E3 move with the arm's group; those of a positioner are a group of its own, GP2.
const std::vector<std::string>& tp_axis_names();
/// Six that turn, of robots without external axes.
const std::vector<std::string>& urscript_axis_names();
const std::vector<std::string>& inform_axis_names();
const std::vector<std::string>& val3_axis_names();

}  // namespace posewright
