#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "command.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright::cli {

/// --package NAME=DIR.
po::options_description package_options();
/// Its values. Throws InputError for a package without name or folder, and for a folder that is not there.
Packages packages_of(const po::variables_map& values);
/// --set KEY=VALUE.
void add_set_option(po::options_description& options);
/// --package NAME=DIR, --set KEY=VALUE and --parameters FILE, for every command that reads a problem file.
po::options_description problem_options();
/// Names of --variant, given once, several times or with commas; none if the command has no such option.
/// Throws InputError for an empty name.
std::vector<std::string> variants_of(const po::variables_map& values);
/// The problem file with what these options say. Variants that keep their nominal values are told on stderr.
/// Throws InputError as read_problem and apply_parameters, for a package without name or folder, and for a folder that
/// is not there.
/// @param changed  keys that a plan states; --set comes after them
Problem given_problem(const std::filesystem::path& file, const po::variables_map& values, KeyEdits changed = {});

/// The problem file of a plan: --problem, else the one that the plan names. Throws InputError if there is none.
std::filesystem::path problem_file(const po::variables_map& values, const std::filesystem::path& plan);
/// given_problem() of that file with the keys that the plan states; without --parameters at its parameters.
Problem problem_for_plan(const std::filesystem::path& file, const po::variables_map& values,
                         const std::filesystem::path& plan);

/// Files that nothing may be written over: the problem file and those it names.
std::vector<std::filesystem::path> files_of(const Problem& problem);

}  // namespace posewright::cli
