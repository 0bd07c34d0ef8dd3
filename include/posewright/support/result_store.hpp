#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace posewright {

/// Results of earlier computations under names that hash all they depend on. What is not there, or no longer, is
/// computed again; so nothing that goes wrong with a store is an error. Safe from several threads and processes.
class ResultStore {
 public:
  virtual ~ResultStore() = default;
  /// @param name  64 hexadecimal digits
  virtual std::optional<std::string> find(const std::string& name) const = 0;
  virtual void keep(const std::string& name, std::string_view bytes) const = 0;
};

/// Files NAME.result in a folder, each whole or not there, with a hash of its bytes. Files that are damaged or of
/// another program are no results. The oldest go where all are more than `most_bytes`; other files are never touched.
class FolderStore : public ResultStore {
 public:
  static constexpr std::uintmax_t most_bytes = 256'000'000;

  /// The folder is made when a result is kept.
  explicit FolderStore(std::filesystem::path folder, std::uintmax_t most = most_bytes);
  std::optional<std::string> find(const std::string& name) const override;
  void keep(const std::string& name, std::string_view bytes) const override;

 private:
  std::filesystem::path file_of(const std::string& name) const;
  void make_room(const std::filesystem::path& just_written) const;

  std::filesystem::path folder_;
  std::uintmax_t most_;
};

/// Folder of kept results: POSEWRIGHT_CACHE; without it, posewright in XDG_CACHE_HOME or in ~/.cache. Empty: there is
/// none, because POSEWRIGHT_CACHE is empty or no such variable names an absolute path.
std::filesystem::path cache_folder();

/// Identity of the program that runs, and of the libraries that judge configurations for it: the numbers that the
/// linker gave their builds. Empty: one of them has none.
std::string build_identity();

}  // namespace posewright
