#pragma once

#include <optional>
#include <string>
#include <vector>

namespace posewright {

struct ProgramOutput {
  int status = 0;  ///< exit status; 128 and more: ended by a signal
  std::string out, error;
};

/// Runs a program of the search path and waits for its end; none if there is no such program.
/// @param words  its name and arguments, taken as they are: no shell reads them
std::optional<ProgramOutput> run_program(const std::vector<std::string>& words);

}  // namespace posewright
