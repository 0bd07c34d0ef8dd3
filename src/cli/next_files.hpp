#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "posewright/tasks/next_state.hpp"

namespace posewright::cli {

/// A file of readings that somebody appends to.
class GrowingFile {
 public:
  explicit GrowingFile(std::filesystem::path file) : file_(std::move(file)) {}
  /// Its whole lines now; empty if it is not there yet.
  WholeLines read() const;
  /// Waits until there are other whole lines than `seen`, or the file is shorter for longer than one who writes it anew
  /// takes. A signal ends the program here: everything is written.
  WholeLines wait_for_more(const std::string& seen) const;
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
};

/// Files for results of `next`; empty: not requested.
struct NextFiles {
  std::filesystem::path state, poses, result;

  /// Each file by itself, so that a state is there at any moment; it knows the pose list, so that a later call may
  /// replace it.
  void write(NextState& state_now, const std::string& csv, const std::string& json) const;
};

/// measured.csv: measured.next-state.json, beside it.
std::filesystem::path usual_state_file(const std::filesystem::path& data);

}  // namespace posewright::cli
