#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace posewright {

struct ProgramRun {
  int exit_code = -1;
  std::string out, err;
};

/// Runs the command-line program in `folder`; SIGINT is sent after `interrupt_after` seconds where that is positive,
/// `signals` times in a row.
ProgramRun run_program(const std::filesystem::path& folder, const std::vector<std::string>& words,
                       double interrupt_after = 0, int signals = 1);

/// Lines of what went to stderr without those that show a line of a file and the caret under it.
int messages_in(const std::string& err);

}  // namespace posewright
