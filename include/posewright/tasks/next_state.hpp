#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posewright/results/plan.hpp"
#include "posewright/tasks/next_poses.hpp"

namespace posewright {

/// State of `next` between calls: data, verdicts, and candidates.
struct NextState {
  std::string problem_file, problem_sha256, parameters_sha256;
  std::string data_file, data_sha256;  ///< of the first `data_bytes`
  std::size_t data_bytes = 0;          ///< whole lines that were seen
  std::vector<NextPoint> history;      ///< as it was predicted then, the last of a number of poses
  std::vector<std::string> names;      ///< of coordinates
  std::vector<std::vector<double>> proposed;
  std::string variant;                         ///< of the candidates
  std::uint64_t seed = 0;                      ///< of the candidates
  std::shared_ptr<const KeptCandidates> kept;  ///< null: a list was given
  std::vector<WrittenWith> files;              ///< that were written with it, as they were and as they will be
};

/// None if there is no such file. Throws InputError for a file that is no state.
std::optional<NextState> read_next_state(const std::filesystem::path& file);

/// Throws InputError in one line if the state belongs to another problem or to other data than these: data may have
/// grown at their end and not changed otherwise.
/// @param file  of the state
/// @param text  whole lines of `data`
void require_continues(const NextState& state, const std::filesystem::path& file, const Problem& problem,
                       const std::filesystem::path& data, const std::string& text);

/// Reuses the data that are still valid. Does not throw: other options draw other candidates.
void reuse(const NextState& state, const Problem& problem, NextOptions& options);

/// The state after a call.
/// @param before  the one it went on from; none: the first call
NextState state_after(const Problem& problem, const NextOptions& options, const NextPoses& result,
                      const std::optional<NextState>& before);
/// Schema posewright/next-state/1.
std::string next_state_text(const NextState& state);

/// The lines of a growing file that have their end: the text after the last one may be half a line.
struct WholeLines {
  std::string text;
  std::string rest;       ///< without an end
  int next_line = 1;      ///< number of the line that `rest` is
  bool has_rows = false;  ///< a line beside the header and comments
};
WholeLines whole_lines(const std::string& bytes);

}  // namespace posewright
