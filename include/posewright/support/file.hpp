#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace posewright {

/// Whole file as bytes. Throws InputError where it is missing, a folder, unreadable or larger than `limit` bytes.
std::string read_file(const std::filesystem::path& file, std::uintmax_t limit = std::uintmax_t(1) << 40);

/// A file read from front to back without holding all of it. Throws InputError as read_file() does.
class FileReader {
 public:
  explicit FileReader(const std::filesystem::path& file);
  /// Up to `count` bytes into `to`; fewer only at the end.
  std::size_t read(char* to, std::size_t count);
  std::uintmax_t size() const { return size_; }

 private:
  std::filesystem::path file_;
  std::ifstream in_;
  std::uintmax_t size_ = 0;
};

/// Writes to a temporary file beside `file` and renames it, so that nobody ever sees half of it.
/// Throws CannotDo naming the file and the system's reason; the temporary file is removed.
void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);

/// Throws CannotDo unless a file can be created at `file` (its folder exists and is writable, it is no folder).
/// Long searches call it before they start.
void require_writable(const std::filesystem::path& file);

}  // namespace posewright
