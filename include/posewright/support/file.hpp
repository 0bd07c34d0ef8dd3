#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace posewright {

/// Whole file as bytes. Throws InputError where it is missing, a folder, unreadable or larger than `limit` bytes.
std::string read_file(const std::filesystem::path& file, std::uintmax_t limit = std::uintmax_t(1) << 40);

/// Writes to a temporary file beside `file` and renames it, so that nobody ever sees half of it.
/// Throws CannotDo naming the file and the system's reason; the temporary file is removed.
void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);

/// Throws CannotDo unless a file can be created at `file` (its folder exists and is writable, it is no folder).
/// Long searches call it before they start.
void require_writable(const std::filesystem::path& file);

}  // namespace posewright
