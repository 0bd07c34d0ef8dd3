#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace posewright {

/// Whole file as bytes. Pipes are read too; endless ones up to `limit`.
/// Throws InputError if it is missing, a folder, a device, unreadable or larger than `limit` bytes.
std::string read_file(const std::filesystem::path& file, std::uintmax_t limit = std::uintmax_t(1) << 31);

/// read_file() of a file that the program writes anew at its end. Throws InputError also for a pipe.
std::string read_file_to_replace(const std::filesystem::path& file, std::uintmax_t limit);

/// A file read from front to back without holding all of it. Throws InputError as read_file() does.
class FileReader {
 public:
  explicit FileReader(const std::filesystem::path& file);
  /// Up to `count` bytes into `to`; fewer only at the end.
  std::size_t read(char* to, std::size_t count);
  /// The next byte that is read is this one of the file.
  void go_to(std::uintmax_t byte);
  std::uintmax_t size() const { return size_; }

 private:
  std::filesystem::path file_;
  std::ifstream in_;
  std::uintmax_t size_ = 0;
};

/// Files that read_file(), FileReader and record_input() have met in this process, as they are called on the disk.
std::vector<std::filesystem::path> files_read();
/// For files that a library reads, before it does.
void record_input(const std::filesystem::path& file);

/// Digest of the files that this process reads while it lives, in any thread: their names without folders, and their
/// bytes, in the order of reading.
class ReadDigest {
 public:
  ReadDigest();
  ~ReadDigest();
  ReadDigest(const ReadDigest&) = delete;
  ReadDigest& operator=(const ReadDigest&) = delete;
  /// Of what was read so far; empty: of a file that was read in parts nothing is known.
  std::string hex() const;

 private:
  friend void note_read(const std::filesystem::path& file, const std::string* bytes);
  std::string files_;
  bool known_ = true;
};

/// Target of a name: links are followed, even one without target. Throws CannotDo for a circle of links.
std::filesystem::path followed(std::filesystem::path file);

struct FileToWrite {
  std::filesystem::path file;
  std::string bytes;
};

/// Writes files that belong together, so that nobody ever sees half of one or a mixture of old and new ones: all are
/// written and flushed under temporary names beside their places, then the old version of the last one (the program,
/// the plan) is removed, the others are renamed, and the last one is renamed at the end. Killed at any moment it leaves
/// the old files, the new ones, or files without the last one. Links are followed, mode and owner of a file that is
/// replaced are kept, devices and pipes are written through.
/// Throws CannotDo naming the file and the system's reason; temporary files are removed, and no file is replaced if one
/// of them could not be written in full.
void write_files(const std::vector<FileToWrite>& files);

/// write_files() of one file.
void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);

/// Throws CannotDo unless write_files() can write `file`: its folder exists and is writable, it is not a folder and not
/// protected against writing. Long searches call it before they start.
void require_writable(const std::filesystem::path& file);

}  // namespace posewright
