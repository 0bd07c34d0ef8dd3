#include "posewright/support/task_log.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>

#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"
#include "posewright/version.hpp"

namespace posewright {
namespace {

// A log: "posewright-tasks/1 VERSION KEY", then records, each a line of text and, for a result, its bytes:
//   group NUMBER COUNT NAME
//   result NUMBER INDEX LENGTH HASH       and LENGTH bytes and a newline
constexpr std::string_view log_name = "posewright-tasks/1";
constexpr std::uintmax_t largest_log = std::uintmax_t(1) << 33;
constexpr std::size_t most_listed = 8;

std::string hash_of(int group, std::size_t index, std::string_view bytes) {
  return sha256_hex(std::to_string(group) + " " + std::to_string(index) + " " + std::string(bytes)).substr(0, 16);
}

std::string header_of(const std::string& version, const std::string& key) {
  std::string header(log_name);
  for (const std::string& part : {version, key}) header += " " + part;
  return header + "\n";
}

std::string group_line(int number, const LoggedTasks::Group& group) {
  return "group " + std::to_string(number) + " " + std::to_string(group.count) + " " + group.name + "\n";
}

std::string result_record(int group, std::size_t index, std::string_view bytes) {
  return "result " + std::to_string(group) + " " + std::to_string(index) + " " + std::to_string(bytes.size()) + " " +
         hash_of(group, index, bytes) + "\n" + std::string(bytes) + "\n";
}

/// Lines and stretches of bytes from the front of a text.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}
  std::optional<std::string_view> line() {
    const auto end = text_.find('\n', at_);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view found = text_.substr(at_, end - at_);
    at_ = end + 1;
    return found;
  }
  std::optional<std::string_view> bytes(std::size_t count) {
    if (count >= text_.size() - at_ || text_[at_ + count] != '\n') return std::nullopt;
    const std::string_view found = text_.substr(at_, count);
    at_ += count + 1;
    return found;
  }
  std::size_t at() const { return at_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// The next word of a line.
std::string_view word(std::string_view& line) {
  const auto end = std::min(line.find(' '), line.size());
  const std::string_view found = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  return found;
}

template <class T>
bool number(std::string_view& line, T& value) {
  const std::string_view text = word(line);
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size() && !text.empty();
}

/// One record; false where it is not whole.
bool read_record(Parser& parser, LoggedTasks& tasks) {
  auto line = parser.line();
  if (!line) return false;
  const std::string_view kind = word(*line);
  int group = 0;
  std::size_t index = 0, length = 0;
  if (!number(*line, group) || !number(*line, index)) return false;
  if (kind == "group") {
    tasks.groups[group] = {std::string(*line), index, {}};
    return true;
  }
  const auto known = tasks.groups.find(group);
  if (kind != "result" || !number(*line, length) || known == tasks.groups.end()) return false;
  const auto bytes = parser.bytes(length);
  if (!bytes || hash_of(group, index, *bytes) != *line || index >= known->second.count) return false;
  known->second.results[index] = std::string(*bytes);
  return true;
}

LoggedTasks parse(const std::filesystem::path& file, std::string_view text) {
  Parser parser(text);
  LoggedTasks tasks;
  auto header = parser.line();
  if (!header || word(*header) != log_name)
    throw InputError({file.string(), 0}, "is no log of finished tasks", "one that --resume began is needed");
  tasks.version = std::string(word(*header));
  tasks.key = std::string(*header);
  do tasks.whole_bytes = parser.at();
  while (read_record(parser, tasks));
  return tasks;
}

void require_same(const LoggedTasks& a, const std::string& version, const std::string& key,
                  const std::filesystem::path& file, const std::string& than) {
  if (a.version != version)
    throw InputError({file.string(), 0}, "was written by posewright " + a.version, "this is " + version);
  if (a.key != key)
    throw InputError({file.string(), 0}, "is of another computation than " + than,
                     "the same command, options and input files are needed");
}

std::string list_of(const LoggedTasks::Group& group) {
  std::string list;
  std::size_t missing = 0;
  for (std::size_t i = 0; i < group.count; ++i)
    if (!group.results.contains(i) && missing++ < most_listed) list += (list.empty() ? "" : ", ") + std::to_string(i);
  return missing > most_listed ? list + ", … (" + std::to_string(missing) + " in all)" : list;
}

}  // namespace

LoggedTasks read_task_log(const std::filesystem::path& file) { return parse(file, read_file(file, largest_log)); }

LoggedTasks merged(const std::vector<std::filesystem::path>& files) {
  LoggedTasks all;
  for (const std::filesystem::path& file : files) {
    LoggedTasks one = read_task_log(file);
    if (&file == &files.front()) {
      all = std::move(one);
      continue;
    }
    require_same(one, all.version, all.key, file, files.front().string());
    for (auto& [number, group] : one.groups) {
      LoggedTasks::Group& known =
          all.groups.try_emplace(number, LoggedTasks::Group{group.name, group.count, {}}).first->second;
      if (known.count != group.count || known.name != group.name)
        throw InputError({file.string(), 0}, "has other tasks than " + files.front().string(), "");
      known.results.merge(group.results);
    }
  }
  for (const auto& [number, group] : all.groups)
    if (group.results.size() < group.count) throw CannotDo("no part has these " + group.name + ": " + list_of(group));
  return all;
}

std::string task_log_bytes(const LoggedTasks& tasks) {
  std::string bytes = header_of(tasks.version, tasks.key);
  for (const auto& [number, group] : tasks.groups) {
    bytes += group_line(number, group);
    for (const auto& [index, result] : group.results) bytes += result_record(number, index, result);
  }
  return bytes;
}

TaskLog::TaskLog(std::filesystem::path file, std::function<std::string()> key)
    : file_(std::move(file)), key_(std::move(key)) {}

TaskLog::~TaskLog() {
  if (descriptor_ < 0) return;
  ::fsync(descriptor_);
  ::close(descriptor_);
}

void TaskLog::open() {
  const auto cannot = [&](const std::string& what) { return CannotDo(file_.string() + ": " + what); };
  const std::string key = key_();
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw cannot(std::string("cannot be written: ") + std::strerror(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) throw cannot("another program is writing to it");
  const std::string text = read_file(file_, largest_log);
  if (text.empty()) {
    known_ = {version, key, {}, 0};
    write(header_of(version, key));
    return;
  }
  known_ = parse(file_, text);
  require_same(known_, version, key, file_, "this one");
  if (::ftruncate(descriptor_, off_t(known_.whole_bytes)) != 0)
    throw cannot(std::string("cannot be cut to its last whole result: ") + std::strerror(errno));
}

const std::map<std::size_t, std::string>& TaskLog::begin(int group, const std::string& name, std::size_t count) {
  if (descriptor_ < 0) open();
  const auto [entry, is_new] = known_.groups.try_emplace(group, LoggedTasks::Group{name, count, {}});
  if (is_new) write(group_line(group, entry->second));
  else if (entry->second.count != count || entry->second.name != name)
    throw InputError({file_.string(), 0}, "is of another computation than this one", "");
  return entry->second.results;
}

void TaskLog::append(int group, std::size_t index, std::string_view bytes) {
  write(result_record(group, index, bytes));
  if (std::chrono::steady_clock::now() - last_flush_ >= std::chrono::seconds(1)) flush();
}

void TaskLog::flush() {
  last_flush_ = std::chrono::steady_clock::now();
  if (descriptor_ >= 0 && ::fsync(descriptor_) != 0 && errno != EINVAL)
    throw CannotDo(file_.string() + ": cannot be written: " + std::strerror(errno));
}

void TaskLog::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t now = ::write(descriptor_, bytes.data(), bytes.size());
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) throw CannotDo(file_.string() + ": cannot be written: " + std::strerror(errno));
    bytes.remove_prefix(std::size_t(now));
  }
}

}  // namespace posewright
