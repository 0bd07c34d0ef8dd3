#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// Reading and writing JSON, compiled once: the library's parser and writer are templates that take a compiler seconds
/// wherever they are met.
namespace posewright {

/// Throws nlohmann::json::parse_error with line and column.
nlohmann::json parse_json(const std::string& text);
/// The same; members keep the order of the text.
nlohmann::ordered_json parse_ordered_json(const std::string& text);

/// Indented by one blank a level and with a line end, or in one line without one.
enum class JsonLayout { indented, one_line };
/// Throws nlohmann::json::type_error where a text is not UTF-8.
std::string json_text(const nlohmann::json& json, JsonLayout layout = JsonLayout::indented);
std::string json_text(const nlohmann::ordered_json& json, JsonLayout layout = JsonLayout::indented);
/// The same; bytes that are not UTF-8 become U+FFFD.
std::string lenient_json_text(const nlohmann::ordered_json& json, JsonLayout layout = JsonLayout::indented);

}  // namespace posewright
