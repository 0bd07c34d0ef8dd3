#pragma once

#include <filesystem>

#include "command.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright::cli {

/// --package NAME=DIR, for every command that reads a problem file.
po::options_description package_options();
/// The problem file with these folders. Throws InputError as read_problem, for a value without name or folder, and for
/// a folder that is not there.
Problem problem_with_packages(const std::filesystem::path& file, const po::variables_map& values);
/// The problem file of a plan: --problem, else the one that the plan names. Throws InputError where there is none.
std::filesystem::path problem_file(const po::variables_map& values, const std::filesystem::path& plan);

}  // namespace posewright::cli
