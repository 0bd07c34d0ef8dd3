#pragma once

#include <memory>

#include "command.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright::cli {

/// --resume LOG, of commands whose tasks follow one from another.
po::options_description resume_option();
/// --resume LOG and --shard i/n, of commands whose work splits into tasks.
po::options_description task_options();

/// Engine of a command's tasks: the processes that the program was started as, with the log and the share that the
/// options name. Throws InputError for a share that is none or without a log, and for --time-limit with several
/// processes: they would stop at different places.
std::unique_ptr<TaskEngine> engine_of(const po::variables_map& values, const std::string& command);

/// Output of --verbose about the tasks: number of known ones, and traffic between processes.
void tell_of_tasks(TaskEngine& engine, const CommonOptions& common);

}  // namespace posewright::cli
