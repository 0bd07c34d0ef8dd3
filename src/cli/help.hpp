#pragma once

#include <string>

#include "command.hpp"

namespace posewright::cli {

/// Text of `posewright --help`.
std::string general_help();
/// Text of `posewright help COMMAND`.
std::string command_help(const Command& command);
/// Throws InputError that lists the commands.
const Command& find_command(const std::string& name);

/// posewright.1 in roff, all commands on one page.
std::string manual_page();
/// Completion of commands, options, names and files. Throws InputError for a shell other than bash and zsh.
std::string completion_script(const std::string& shell);

/// Purpose and example in the help.
inline constexpr const char* purpose = "plans which poses to measure before a robot is calibrated";
inline constexpr const char* general_example =
    "posewright plan examples/telescope/problem.yaml -o plan.json --poses-csv poses.csv";

}  // namespace posewright::cli
