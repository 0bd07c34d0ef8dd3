#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// Reading and writing JSON, compiled once: the library's parser and writer are templates that take a compiler seconds
/// wherever they are met.
namespace posewright {

/// Throws nlohmann::json::parse_error with line and column.
nlohmann::json parse_json(const std::string& text);
/// Variant that keeps the order of members.
nlohmann::ordered_json parse_ordered_json(const std::string& text);

/// Indented by one blank a level and with a line end, or in one line without one.
enum class JsonLayout { indented, one_line };
/// Bytes that are not UTF-8 become U+FFFD: a folder's name may have them.
std::string json_text(const nlohmann::json& json, JsonLayout layout = JsonLayout::indented);
std::string json_text(const nlohmann::ordered_json& json, JsonLayout layout = JsonLayout::indented);

}  // namespace posewright
