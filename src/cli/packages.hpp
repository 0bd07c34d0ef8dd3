#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"

namespace posewright::cli {

/// --package NAME=DIR, for every command that reads a problem file.
po::options_description package_options();
/// Throws InputError for a value without name or folder, and for a folder that is not there.
std::vector<std::pair<std::string, std::filesystem::path>> packages_of(const po::variables_map& values);

}  // namespace posewright::cli
