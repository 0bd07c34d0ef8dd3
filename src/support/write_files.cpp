#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"

namespace posewright {
namespace fs = std::filesystem;
namespace {

// Links that lead to links: as many as the system follows.
constexpr int most_links = 40;
// Where a mode has none of these, nobody is meant to write.
constexpr mode_t write_bits = S_IWUSR | S_IWGRP | S_IWOTH;

[[noreturn]] void cannot_write(const fs::path& file, const std::string& reason) {
  throw CannotDo(file.string() + ": cannot be written: " + reason);
}
[[noreturn]] void cannot_write(const fs::path& file) { cannot_write(file, std::strerror(errno)); }

/// Devices and pipes keep their place and take the bytes; so does whatever a shell put behind /dev/stdout.
bool is_written_through(const fs::path& file) {
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (!fs::exists(status) || fs::is_directory(status)) return false;
  const std::string name = file.lexically_normal().string();
  return !fs::is_regular_file(status) || name.starts_with("/dev/") || name.starts_with("/proc/");
}

void write_all(int descriptor, std::string_view bytes, const fs::path& file) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) cannot_write(file);
    bytes.remove_prefix(std::size_t(n));
  }
}

/// On the disk, not only on its way there. Some file systems cannot promise it, and say so.
void flush(int descriptor, const fs::path& file) {
  if (::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EROFS) cannot_write(file);
}

void flush_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // A folder that may be written to but not read: nothing to be done about it.
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

/// Owns a temporary file until it is renamed; unlinks it otherwise.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target), name_(target.string() + ".XXXXXX") {
    descriptor_ = ::mkostemp(name_.data(), O_CLOEXEC);
    if (descriptor_ < 0) cannot_write(target);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(name_.c_str());
  }

  const fs::path& target() const { return target_; }

  void write(std::string_view bytes) {
    write_all(descriptor_, bytes, target_);
    take_over_mode();
    flush(descriptor_, target_);
    if (::close(std::exchange(descriptor_, -1)) != 0) cannot_write(target_);
  }

  void rename() {
    if (::rename(name_.c_str(), target_.c_str()) != 0) cannot_write(target_);
    renamed_ = true;
  }

 private:
  /// Mode of the replaced file; the usual mode for a new one.
  void take_over_mode() const {
    struct stat old {};
    if (::stat(target_.c_str(), &old) == 0) {
      // Only root can give a file away: elsewhere it then belongs to who wrote it.
      if (::fchown(descriptor_, old.st_uid, old.st_gid) != 0) errno = 0;
      if (::fchmod(descriptor_, old.st_mode & 07777U) != 0) cannot_write(target_);
      return;
    }
    const mode_t mask = ::umask(0);
    ::umask(mask);
    if (::fchmod(descriptor_, 0666U & ~mask) != 0) cannot_write(target_);
  }

  fs::path target_;
  std::string name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

void write_through(const FileToWrite& file) {
  const int descriptor = ::open(file.file.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) cannot_write(file.file);
  try {
    write_all(descriptor, file.bytes, file.file);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  if (::close(descriptor) != 0) cannot_write(file.file);
}

}  // namespace

fs::path followed(fs::path file) {
  std::error_code code;
  for (int i = 0; fs::is_symlink(fs::symlink_status(file, code)); ++i) {
    if (i == most_links) cannot_write(file, std::strerror(ELOOP));
    const fs::path to = fs::read_symlink(file, code);
    if (code) cannot_write(file, code.message());
    file = to.is_absolute() ? to : file.parent_path() / to;
  }
  return file;
}

void write_files(const std::vector<FileToWrite>& files) {
  std::vector<std::unique_ptr<TemporaryFile>> written;
  for (const FileToWrite& file : files) {
    require_writable(file.file);
    if (is_written_through(file.file)) continue;
    written.push_back(std::make_unique<TemporaryFile>(followed(file.file)));
    written.back()->write(file.bytes);
  }
  for (const FileToWrite& file : files)
    if (is_written_through(file.file)) write_through(file);
  if (written.empty()) return;
  // New points must never meet an old program: while they change there is none.
  if (written.size() > 1 && ::unlink(written.back()->target().c_str()) == 0) flush_folder(written.back()->target());
  for (const auto& file : written) {
    file->rename();
    flush_folder(file->target());
  }
}

void write_file_atomically(const fs::path& file, std::string_view bytes) { write_files({{file, std::string(bytes)}}); }

void require_writable(const fs::path& file) {
  std::error_code code;
  if (fs::is_directory(file, code)) cannot_write(file, "is a folder");
  if (is_written_through(file)) {
    if (::access(file.c_str(), W_OK) != 0) cannot_write(file);
    return;
  }
  const fs::path target = followed(file);
  struct stat old {};
  // Renaming would pass over it, and root may write everything: the mode is asked.
  if (::stat(target.c_str(), &old) == 0 && (old.st_mode & write_bits) == 0)
    cannot_write(file, "is protected against writing");
  const TemporaryFile probe(target);
}

}  // namespace posewright
