#pragma once

#include <atomic>

namespace posewright::cli {

/// Effect of Ctrl-C, SIGTERM and SIGHUP on this program, stage by stage. Before the first result they end it at once,
/// with the exit code `interrupted`; while a search runs they ask for the best so far; from then on, until everything
/// is written and told, they are passed over. A second one always ends it.
enum class SignalStage { nothing_to_lose, searching, finishing };

/// Called first: signals as above (one that was ignored by whoever started the program stays ignored if it is SIGHUP);
/// writing to a closed pipe or past a limit fails instead of ending the program; descriptors 0 to 2 that are closed
/// are taken, so that no file gets their numbers and what is meant for a terminal.
void prepare_process();

/// Begins a stage. If there was a signal before, `searching` ends at once with what it has, `nothing_to_lose` ends the
/// program.
void begin_stage(SignalStage stage);

/// Set by a signal while a search runs.
const std::atomic<bool>& interrupted_flag();

}  // namespace posewright::cli
