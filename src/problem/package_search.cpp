#include "posewright/problem/package_search.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <string_view>

#include "posewright/support/trimmed.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view file_scheme = "file://";
// Gazebo calls packages models.
constexpr std::array<std::string_view, 2> package_schemes{"package://", "model://"};

/// Variables that list folders, and where in those packages lie.
constexpr std::array<std::pair<const char*, const char*>, 4> folder_variables{{{"ROS_PACKAGE_PATH", ""},
                                                                               {"AMENT_PREFIX_PATH", "share"},
                                                                               {"GZ_SIM_RESOURCE_PATH", ""},
                                                                               {"GAZEBO_MODEL_PATH", ""}}};
// Packages beside the file's own, in the same repository or workspace.
constexpr int levels_above = 5, levels_below = 2;

std::vector<fs::path> folders_above(const fs::path& file) {
  std::vector<fs::path> folders;
  if (file.empty()) return folders;
  std::error_code code;
  const fs::path start = fs::absolute(file, code).lexically_normal().parent_path();
  for (fs::path folder = start; folder.has_relative_path(); folder = folder.parent_path()) folders.push_back(folder);
  return folders;
}

/// Folders in which NAME may lie: those of the environment, then those above the file.
std::vector<fs::path> search_folders(const fs::path& around) {
  std::vector<fs::path> folders;
  for (const auto& [variable, below] : folder_variables) {
    const char* value = std::getenv(variable);
    const std::string text = value == nullptr ? "" : value;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(':', begin), text.size());
      if (end > begin) folders.push_back(fs::path(text.substr(begin, end - begin)) / below);
      begin = end + 1;
    }
  }
  for (const fs::path& folder : folders_above(around)) folders.push_back(folder);
  return folders;
}

/// True if the folder's package.xml names package `name`.
bool declares(const fs::path& folder, const std::string& name) {
  std::error_code code;
  if (!fs::is_regular_file(folder / "package.xml", code)) return false;
  tinyxml2::XMLDocument document;
  if (document.LoadFile((folder / "package.xml").c_str()) != tinyxml2::XML_SUCCESS) return false;
  const tinyxml2::XMLElement* root = document.FirstChildElement("package");
  const tinyxml2::XMLElement* declared = root == nullptr ? nullptr : root->FirstChildElement("name");
  return declared != nullptr && declared->GetText() != nullptr && trimmed(declared->GetText()) == name;
}

/// The folder that declares itself package `name`, this one or one below; empty: none.
fs::path declared_package(const fs::path& folder, const std::string& name, int levels) {
  if (declares(folder, name)) return folder;
  std::error_code code;
  if (levels == 0) return {};
  std::set<fs::path> below;  // in the order of their names, as folders list theirs in any
  for (fs::directory_iterator at(folder, fs::directory_options::skip_permission_denied, code), end; !code && at != end;
       at.increment(code))
    if (at->is_directory(code) && !at->is_symlink(code)) below.insert(at->path());
  for (const fs::path& child : below)
    if (const fs::path found = declared_package(child, name, levels - 1); !found.empty()) return found;
  return {};
}

std::string_view scheme_of(const std::string& name) {
  const auto scheme = std::find_if(package_schemes.begin(), package_schemes.end(),
                                   [&](std::string_view known) { return name.starts_with(known); });
  return scheme == package_schemes.end() ? std::string_view() : *scheme;
}

}  // namespace

fs::path find_package(const std::string& name, const Packages& given, const fs::path& around,
                      const SourcePlace& place) {
  for (const auto& [known, folder] : given)
    if (known == name) return folder;
  std::error_code code;
  for (const fs::path& folder : search_folders(around)) {
    if (folder.filename() == name) return folder;
    if (fs::is_directory(folder / name, code)) return folder / name;
  }
  std::vector<fs::path> above = folders_above(around);
  above.resize(std::min(above.size(), std::size_t(levels_above)));
  for (const fs::path& folder : above)
    if (const fs::path found = declared_package(folder, name, levels_below); !found.empty()) return found;
  throw InputError(place, "package '" + name + "' is not found",
                   "name its folder with --package " + name + "=FOLDER or in ROS_PACKAGE_PATH");
}

bool names_package(const std::string& name) { return !scheme_of(name).empty(); }

fs::path file_of_uri(const fs::path& name, const Packages& given, const fs::path& around, const SourcePlace& place) {
  const std::string text = name.string();
  if (text.starts_with(file_scheme)) return text.substr(file_scheme.size());
  const std::string_view scheme = scheme_of(text);
  if (scheme.empty()) return name;
  const std::string path = text.substr(scheme.size());
  const std::size_t slash = path.find('/');
  if (slash == std::string::npos || slash == 0)
    throw InputError(place, "'" + text + "' names no file", std::string(scheme) + "NAME/PATH is expected");
  return find_package(path.substr(0, slash), given, around, place) / path.substr(slash + 1);
}

fs::path find_model(const std::string& uri, const Packages& given, const fs::path& around) {
  const std::string_view scheme = scheme_of(uri);
  if (scheme.empty()) return {};
  const std::string path = uri.substr(scheme.size());
  const std::size_t slash = std::min(path.find('/'), path.size());
  try {
    const fs::path folder = find_package(path.substr(0, slash), given, around, {});
    return slash == path.size() ? folder : folder / path.substr(slash + 1);
  } catch (const InputError&) {
    return {};  // the caller says what is missing, and where it is named
  }
}

}  // namespace posewright
