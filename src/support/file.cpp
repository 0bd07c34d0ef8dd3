#include "posewright/support/file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <mutex>

#include "posewright/support/error.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright {
namespace fs = std::filesystem;
namespace {

/// Files read by the process, which must not overwrite its own inputs.
struct InputRecord {
  std::mutex mutex;
  std::vector<fs::path> files;
  std::vector<ReadDigest*> digests;  // that live
};

InputRecord& input_record() {
  static InputRecord record;
  return record;
}

/// Folders have no bytes, and devices no end. Pipes are what a shell's <(…) gives.
void require_bytes(const fs::path& file) {
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (fs::is_directory(status)) throw InputError({file.string(), 0}, "is a folder", "a file is needed");
  if (fs::is_character_file(status) || fs::is_block_file(status))
    throw InputError({file.string(), 0}, "is a device", "a file or a pipe is needed");
}

std::string bytes_of(const fs::path& file, std::uintmax_t limit) {
  const SourcePlace place{file.string(), 0};
  require_bytes(file);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(place, std::string("cannot be read: ") + std::strerror(errno), "");
  std::error_code code;
  const auto size = fs::file_size(file, code);
  const std::string allowed = "at most " + std::to_string(limit) + " are read";
  if (!code && size > limit) throw InputError(place, "has " + std::to_string(size) + " bytes", allowed);
  std::string bytes;
  constexpr std::size_t step = 1 << 16;
  while (in) {
    const std::size_t before = bytes.size();
    bytes.resize(before + step);
    in.read(bytes.data() + before, std::streamsize(step));
    bytes.resize(before + std::size_t(in.gcount()));
    if (bytes.size() > limit) throw InputError(place, "has more than " + std::to_string(limit) + " bytes", allowed);
  }
  if (in.bad()) throw InputError(place, "cannot be read to its end", "");
  return bytes;
}

void record_name(const fs::path& file) {
  std::error_code code;
  fs::path name = fs::canonical(file, code);
  if (code) return;
  InputRecord& record = input_record();
  const std::lock_guard lock(record.mutex);
  if (std::find(record.files.begin(), record.files.end(), name) == record.files.end())
    record.files.push_back(std::move(name));
}

bool somebody_digests() {
  InputRecord& record = input_record();
  const std::lock_guard lock(record.mutex);
  return !record.digests.empty();
}

}  // namespace

/// @param bytes  null: they are not known
void note_read(const fs::path& file, const std::string* bytes) {
  if (!somebody_digests()) return;
  const std::string hash = bytes == nullptr ? "" : sha256_hex(*bytes);
  InputRecord& record = input_record();
  const std::lock_guard lock(record.mutex);
  for (ReadDigest* digest : record.digests) {
    digest->known_ = digest->known_ && bytes != nullptr;
    digest->files_ += hash + file.filename().string() + '\n';
  }
}

ReadDigest::ReadDigest() {
  InputRecord& record = input_record();
  const std::lock_guard lock(record.mutex);
  record.digests.push_back(this);
}

ReadDigest::~ReadDigest() {
  InputRecord& record = input_record();
  const std::lock_guard lock(record.mutex);
  std::erase(record.digests, this);
}

std::string ReadDigest::hex() const {
  const std::lock_guard lock(input_record().mutex);
  return known_ ? sha256_hex(files_) : "";
}

std::string read_file(const fs::path& file, std::uintmax_t limit) {
  std::string bytes = bytes_of(file, limit);
  record_name(file);
  note_read(file, &bytes);
  return bytes;
}

std::string read_file_to_replace(const fs::path& file, std::uintmax_t limit) {
  std::error_code code;
  if (fs::exists(file, code) && !fs::is_regular_file(file, code))
    throw InputError({file.string(), 0}, "is not an ordinary file", "a file that can be written anew");
  std::string bytes = bytes_of(file, limit);
  note_read(file, &bytes);
  return bytes;
}

FileReader::FileReader(const fs::path& file) : file_(file) {
  const SourcePlace place{file.string(), 0};
  require_bytes(file);
  in_.open(file, std::ios::binary);
  std::error_code code;
  if (!in_) throw InputError(place, std::string("cannot be read: ") + std::strerror(errno), "");
  size_ = fs::file_size(file, code);
  if (code) throw InputError(place, "is not an ordinary file", "a file is needed");
  record_name(file);
  note_read(file, nullptr);
}

std::size_t FileReader::read(char* to, std::size_t count) {
  in_.read(to, std::streamsize(count));
  if (in_.bad()) throw InputError({file_.string(), 0}, "cannot be read to its end", "");
  return std::size_t(in_.gcount());
}

void FileReader::go_to(std::uintmax_t byte) { in_.seekg(std::streamoff(byte)); }

std::vector<fs::path> files_read() {
  InputRecord& record = input_record();
  const std::lock_guard lock(record.mutex);
  return record.files;
}

void record_input(const fs::path& file) {
  record_name(file);
  if (!somebody_digests()) return;
  const std::string bytes = bytes_of(file, std::numeric_limits<std::uintmax_t>::max());
  note_read(file, &bytes);
}

}  // namespace posewright
