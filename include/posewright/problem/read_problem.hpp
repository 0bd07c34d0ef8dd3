#pragma once

#include <filesystem>
#include <string>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Reads a problem file (YAML, at most 10 MB). Throws InputError with the line of the first thing that is wrong.
/// @param packages  folders of packages that the user names: become Problem::packages
/// @param changed   keys with other values than in the file, in this order: a later one may lie in an earlier one.
///                  Entries of a list are 1, 2, …; paths in values are relative to the working directory. Messages name
///                  "--set KEY".
Problem read_problem(const std::filesystem::path& file, const Packages& packages = {}, const KeyEdits& changed = {});

/// Overload for text in memory; `file` names it in messages, and paths in it are relative to its folder.
Problem parse_problem(const std::string& text, const std::filesystem::path& file, const Packages& packages = {},
                      const KeyEdits& changed = {});

}  // namespace posewright
