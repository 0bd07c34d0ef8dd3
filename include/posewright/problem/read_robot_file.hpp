#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "posewright/problem/robot_specs.hpp"

namespace posewright {

/// An arm that no problem file names yet: its URDF, or the expansion of a .xacro file by the program `xacro`.
/// Throws InputError as a problem file that names it, and for arguments of a file that is no xacro file.
SerialArmSpec read_robot_file(const std::filesystem::path& file,
                              const std::vector<std::pair<std::string, std::string>>& arguments);

}  // namespace posewright
