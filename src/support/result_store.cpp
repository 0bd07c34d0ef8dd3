#include "posewright/support/result_store.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view result_mark = "posewright result 1\n", result_ending = ".result";
constexpr std::size_t hash_digits = 64;
// A single result may take this part of a store.
constexpr std::uintmax_t largest_part = 4;
// A writer that was killed leaves a temporary file, which no other writes any more after so long.
constexpr std::chrono::hours abandoned{1};

bool is_hash(std::string_view text) {
  return text.size() == hash_digits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// NAME.result, and what write_files() calls it while it is written: NAME.result.XXXXXX.
bool is_result(const std::string& file) {
  return is_hash(std::string_view(file).substr(0, hash_digits)) &&
         std::string_view(file).substr(hash_digits).starts_with(result_ending);
}

std::string framed(const std::string& name, std::string_view bytes) {
  std::string text(result_mark);
  text += name + '\n' + sha256_hex(bytes) + '\n';
  return text += bytes;
}

/// A file that begins otherwise is somebody else's.
bool may_replace(const fs::path& file) {
  std::error_code code;
  if (!fs::exists(fs::symlink_status(file, code))) return true;
  if (!fs::is_regular_file(fs::symlink_status(file, code))) return false;
  std::ifstream in(file, std::ios::binary);
  std::string begin(result_mark.size(), '\0');
  in.read(begin.data(), std::streamsize(begin.size()));
  begin.resize(std::size_t(std::max(in.gcount(), std::streamsize(0))));
  return result_mark.starts_with(begin);
}

fs::path absolute_path_in(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path path = value == nullptr ? "" : value;
  return path.is_absolute() ? path : fs::path();
}

}  // namespace

FolderStore::FolderStore(fs::path folder, std::uintmax_t most) : folder_(std::move(folder)), most_(most) {}

fs::path FolderStore::file_of(const std::string& name) const { return folder_ / (name + std::string(result_ending)); }

std::optional<std::string> FolderStore::find(const std::string& name) const {
  const fs::path file = file_of(name);
  std::error_code code;
  if (!fs::is_regular_file(file, code)) return std::nullopt;
  try {
    const std::string text = read_file_to_replace(file, most_);
    const std::size_t head = result_mark.size() + 2 * (hash_digits + 1);
    if (text.size() < head) return std::nullopt;
    const std::string_view bytes = std::string_view(text).substr(head);
    if (std::string_view(text).substr(0, head) != framed(name, bytes).substr(0, head)) return std::nullopt;
    // The oldest are those that were not used for the longest time.
    fs::last_write_time(file, fs::file_time_type::clock::now(), code);
    return std::string(bytes);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void FolderStore::keep(const std::string& name, std::string_view bytes) const {
  if (folder_.empty() || bytes.size() > most_ / largest_part) return;
  std::error_code code;
  if (fs::create_directories(folder_, code)) fs::permissions(folder_, fs::perms::owner_all, code);
  const fs::path file = file_of(name);
  if (!fs::is_directory(folder_, code) || !may_replace(file)) return;
  try {
    write_file_atomically(file, framed(name, bytes));
  } catch (const CannotDo&) {
    return;  // a folder that is read-only, a full disk
  }
  make_room(file);
}

void FolderStore::make_room(const fs::path& just_written) const {
  struct Kept {
    fs::file_time_type used;
    fs::path file;
    std::uintmax_t bytes;
  };
  std::vector<Kept> kept;
  std::uintmax_t all = 0;
  std::error_code code;
  const auto now = fs::file_time_type::clock::now();
  for (fs::directory_iterator entry(folder_, code), end; !code && entry != end; entry.increment(code)) {
    std::error_code own;
    if (!is_result(entry->path().filename().string()) || !entry->is_regular_file(own)) continue;
    const Kept result{entry->last_write_time(own), entry->path(), entry->file_size(own)};
    if (own) continue;  // another process took it away
    if (result.file.extension() != result_ending) {
      if (now - result.used > abandoned) fs::remove(result.file, own);
      continue;
    }
    all += result.bytes;
    if (result.file != just_written) kept.push_back(result);
  }
  std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
  for (auto oldest = kept.begin(); oldest != kept.end() && all > most_; ++oldest) {
    if (!may_replace(oldest->file)) continue;
    all -= oldest->bytes;
    fs::remove(oldest->file, code);
  }
}

fs::path cache_folder() {
  if (std::getenv("POSEWRIGHT_CACHE") != nullptr) return absolute_path_in("POSEWRIGHT_CACHE");
  if (const fs::path stated = absolute_path_in("XDG_CACHE_HOME"); !stated.empty()) return stated / "posewright";
  const fs::path home = absolute_path_in("HOME");
  return home.empty() ? home : home / ".cache" / "posewright";
}

}  // namespace posewright
