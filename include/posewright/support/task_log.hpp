#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace posewright {

/// Content of a log of finished tasks: groups in the order in which a program runs them.
struct LoggedTasks {
  struct Group {
    std::string name;
    std::size_t count = 0;
    std::map<std::size_t, std::string> results;  // by index
  };
  std::string version;  ///< of the program that wrote it
  std::string key;      ///< identity of the computation: input files and options
  std::map<int, Group> groups;
  std::size_t whole_bytes = 0;  ///< up to the end of the last whole record: the rest was cut short
};

/// Throws InputError if the file is no log. A record that was cut short, and what follows it, is left out.
LoggedTasks read_task_log(const std::filesystem::path& file);

/// The logs of several shards as one. Throws InputError if they are of different computations, and CannotDo, naming
/// them, if a group lacks tasks.
LoggedTasks merged(const std::vector<std::filesystem::path>& files);
/// As bytes of a log file.
std::string task_log_bytes(const LoggedTasks& tasks);

/// A file that finished tasks are appended to, so that a program that was killed goes on where it was. It is locked
/// while it is open. Appended results are on the disk a second later at the most.
class TaskLog {
 public:
  /// @param key  called at the first group: identity of the computation, once all input is read
  TaskLog(std::filesystem::path file, std::function<std::string()> key);
  ~TaskLog();
  TaskLog(const TaskLog&) = delete;
  TaskLog& operator=(const TaskLog&) = delete;

  /// Results of the group that are there already; begins it if there are none. Throws InputError if the log is of
  /// another computation, another version of the program, or no log at all, CannotDo if another program has it open or
  /// it cannot be written.
  const std::map<std::size_t, std::string>& begin(int group, const std::string& name, std::size_t count);
  void append(int group, std::size_t index, std::string_view bytes);
  void flush();
  const std::filesystem::path& file() const { return file_; }

 private:
  void open();
  void write(std::string_view bytes);

  std::filesystem::path file_;
  std::function<std::string()> key_;
  LoggedTasks known_;
  int descriptor_ = -1;
  std::chrono::steady_clock::time_point last_flush_{};
};

}  // namespace posewright
