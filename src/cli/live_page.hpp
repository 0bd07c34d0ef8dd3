#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "posewright/support/file.hpp"

namespace posewright::cli {

/// A file of the installation that this program belongs to, else of the folder it was built in; empty if neither has
/// it.
/// @param places  paths from a folder above the program, the first that is there is taken
std::filesystem::path installed_file(const std::vector<std::string>& places);

/// posewright.html with a problem in it, as bytes.
/// @param problem  its folder is the root of the page's files; names of files elsewhere are changed in the page's copy
/// @param files    that the problem names; the page itself puts meshes where the URDF names them
/// Throws CannotDo if posewright.html is not in this installation.
std::string page_with_problem(const FileToWrite& problem, const std::vector<FileToWrite>& files);
/// Throws CannotDo if posewright.html is not in this installation.
void require_live_page();

/// Shows a page in the user's browser without waiting for it; false where none can be started.
bool open_in_browser(const std::filesystem::path& page);

}  // namespace posewright::cli
