#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "posewright/support/error.hpp"

namespace posewright {

/// Folders of packages that a user names.
using Packages = std::vector<std::pair<std::string, std::filesystem::path>>;

/// Folder of a ROS package (or Gazebo model): named by the user, or a folder of that name in those of ROS_PACKAGE_PATH,
/// AMENT_PREFIX_PATH, GZ_SIM_RESOURCE_PATH and GAZEBO_MODEL_PATH or above `around`, or one near there whose package.xml
/// says so. Throws InputError at `place` if there is none.
/// @param around  a file; empty: nothing is looked for around it
std::filesystem::path find_package(const std::string& name, const Packages& given, const std::filesystem::path& around,
                                   const SourcePlace& place);

/// True if a name begins as package://NAME/… or model://NAME/….
bool names_package(const std::string& name);

/// Path of package://NAME/PATH, model://NAME/PATH and file://PATH; other names stay. Throws as
/// find_package().
std::filesystem::path file_of_uri(const std::filesystem::path& name, const Packages& given,
                                  const std::filesystem::path& around, const SourcePlace& place);

/// Folder or file that package://NAME… or model://NAME… means; empty: not found, or another name.
std::filesystem::path find_model(const std::string& uri, const Packages& given, const std::filesystem::path& around);

}  // namespace posewright
