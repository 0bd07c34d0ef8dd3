#pragma once

#include <filesystem>
#include <string>

#include "posewright/report/report.hpp"

namespace posewright {

/// True if a file is a plan of a robot, whose report is report_problem(). Throws InputError for a file that is neither
/// that nor a result with a page of its own.
bool is_plan(const std::filesystem::path& file);

/// The page of a result as calibrate, compare, next, simulate and stations print it with --json: nothing is computed
/// again. Throws InputError for a file that is none, or lacks data of its page.
ResultReport report_result(const std::filesystem::path& file);

/// The robot's name as a page is called: the problem file's, or its folder's if it is called "problem".
std::string title_of(const std::filesystem::path& problem);

}  // namespace posewright
