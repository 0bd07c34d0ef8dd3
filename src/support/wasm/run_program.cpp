#include "posewright/support/run_program.hpp"

namespace posewright {

// WebAssembly starts no other programs.
std::optional<ProgramOutput> run_program(const std::vector<std::string>&) { return std::nullopt; }

}  // namespace posewright
