#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace posewright {

/// Throws InputError with the line of the first byte that cannot be part of a text file in UTF-8.
void require_text(std::string_view bytes, const std::string& file);

/// read_file() of a text. Throws InputError also as require_text() does: names from a file of another encoding would
/// end in results that cannot be written.
std::string read_text(const std::filesystem::path& file, std::uintmax_t limit);

/// read_text() of XML that may declare another encoding (`<?xml version="1.0" encoding="ISO-8859-1"?>`, UTF-16 by its
/// byte order mark): the text is converted, and declares UTF-8. Throws InputError for an encoding that is not known.
std::string read_xml_text(const std::filesystem::path& file, std::uintmax_t limit);

}  // namespace posewright
