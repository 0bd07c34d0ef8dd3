#include "posewright/support/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "posewright/support/error.hpp"

namespace posewright {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void cannot_write(const fs::path& file, const std::string& reason) {
  throw CannotDo(file.string() + ": cannot be written: " + reason);
}

/// Owns a temporary file until it is renamed; unlinks it otherwise.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target), name_(target.string() + ".XXXXXX") {
    descriptor_ = ::mkstemp(name_.data());
    if (descriptor_ < 0) cannot_write(target, std::strerror(errno));
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(name_.c_str());
  }

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) cannot_write(target_, std::strerror(errno));
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
  }

  void rename() {
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(descriptor_, 0666 & ~mask);
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0 || ::rename(name_.c_str(), target_.c_str()) != 0) cannot_write(target_, std::strerror(errno));
    renamed_ = true;
  }

 private:
  fs::path target_;
  std::string name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

}  // namespace

std::string read_file(const fs::path& file, std::uintmax_t limit) {
  const SourcePlace place{file.string(), 0};
  std::error_code code;
  if (fs::is_directory(file, code)) throw InputError(place, "is a folder", "a file is needed");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(place, std::string("cannot be read: ") + std::strerror(errno), "");
  const auto size = fs::file_size(file, code);
  if (!code && size > limit)
    throw InputError(place, "has " + std::to_string(size) + " bytes", "at most " + std::to_string(limit) + " are read");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

FileReader::FileReader(const fs::path& file) : file_(file), in_(file, std::ios::binary) {
  const SourcePlace place{file.string(), 0};
  std::error_code code;
  if (fs::is_directory(file, code)) throw InputError(place, "is a folder", "a file is needed");
  if (!in_) throw InputError(place, std::string("cannot be read: ") + std::strerror(errno), "");
  size_ = fs::file_size(file, code);
  if (code) throw InputError(place, "is no ordinary file", "a file is needed");
}

std::size_t FileReader::read(char* to, std::size_t count) {
  in_.read(to, std::streamsize(count));
  if (in_.bad()) throw InputError({file_.string(), 0}, "cannot be read to its end", "");
  return std::size_t(in_.gcount());
}

void write_file_atomically(const fs::path& file, std::string_view bytes) {
  if (fs::is_directory(file)) cannot_write(file, "is a folder");
  TemporaryFile temporary(file);
  temporary.write(bytes);
  temporary.rename();
}

void require_writable(const fs::path& file) {
  if (fs::is_directory(file)) cannot_write(file, "is a folder");
  const TemporaryFile probe(file);
}

}  // namespace posewright
