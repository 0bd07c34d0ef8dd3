#pragma once

#include <filesystem>
#include <string>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Reads a problem file (YAML, at most 10 MB). Throws InputError with the line of the first thing that is wrong.
Problem read_problem(const std::filesystem::path& file);

/// The same for text already in memory; `file` names it in messages, and paths in it are relative to its folder.
Problem parse_problem(const std::string& text, const std::filesystem::path& file);

}  // namespace posewright
