#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "posewright/controller/controller_settings.hpp"

namespace posewright {

/// Controllers of the folder `controllers` of the sources, by names such as "kuka-kr-c4".
std::vector<std::string> known_controllers();

/// True if controller_settings() reads it as the name of a file.
bool is_controller_file(const std::string& name_or_file, const std::filesystem::path& folder = {});

/// Settings of a known controller by its name, or those of a file.
/// @param folder  that a relative file name begins in
/// Throws InputError for other names, and as parse_controller_settings().
ControllerSettings controller_settings(const std::string& name_or_file, const std::filesystem::path& folder = {});

}  // namespace posewright
