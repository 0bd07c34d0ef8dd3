#include "posewright/formats/format_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "posewright/support/json.hpp"

namespace posewright::formats {
namespace {

// U+00C0 to U+00FF.
constexpr std::array<const char*, 64> latin = {"A", "A", "A",  "A", "Ae", "A",  "Ae", "C", "E",  "E",  "E",  "E", "I",
                                               "I", "I", "I",  "D", "N",  "O",  "O",  "O", "O",  "Oe", "x",  "O", "U",
                                               "U", "U", "Ue", "Y", "Th", "ss", "a",  "a", "a",  "a",  "ae", "a", "ae",
                                               "c", "e", "e",  "e", "e",  "i",  "i",  "i", "i",  "d",  "n",  "o", "o",
                                               "o", "o", "oe", "/", "o",  "u",  "u",  "u", "ue", "y",  "th", "y"};

/// Length of the UTF-8 sequence that a byte begins; 1 for anything malformed.
std::size_t sequence_length(unsigned char first) {
  if (first >= 0xF0) return 4;
  if (first >= 0xE0) return 3;
  return first >= 0xC2 ? 2 : 1;
}

std::string plain(std::string_view sequence) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(sequence[i]); };
  if (sequence.size() == 1)
    return byte(0) < 0x80 ? (byte(0) < 0x20 || byte(0) == 0x7F ? " " : std::string(sequence)) : "?";
  if (sequence.size() == 2 && byte(0) == 0xC3 && byte(1) >= 0x80 && byte(1) < 0xC0) return latin[byte(1) - 0x80U];
  if (sequence == "µ" || sequence == "μ") return "u";
  if (sequence == "°") return "deg";
  if (sequence == "–" || sequence == "—" || sequence == "−") return "-";
  if (sequence == "’" || sequence == "‘") return "'";
  return "?";
}

/// A text that every YAML reader takes for a text as it is.
bool is_plain_yaml(const std::string& text) {
  if (text.empty() || text.size() > 200) return false;
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  for (const char c : text)
    if (!letter(c) && !(c >= '0' && c <= '9') && c != '.' && c != '-' && c != '/') return false;
  if (!letter(text.front())) return false;
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (const char* word : {"y", "n", "yes", "no", "on", "off", "true", "false", "null", "nan", "inf"})
    if (lower == word) return false;
  return true;
}

template <class T, class Text>
std::string list(const std::vector<T>& items, const Text& text) {
  std::string result = "[";
  for (const T& item : items) result += (result.size() > 1 ? ", " : "") + text(item);
  return result + "]";
}

}  // namespace

double to_degrees(double radians) { return radians * (180 / std::numbers::pi); }

double to_degrees_or_millimetres(double value, const std::string& unit) {
  return unit == "m" ? value * 1e3 : to_degrees(value);
}

std::string fixed(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string short_fixed(double value, int decimals) {
  std::string text = fixed(value, decimals);
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string shortest(double value) { return fmt::format("{}", value == 0 ? 0.0 : value); }

std::string yaml_number(double value) {
  if (std::isnan(value)) return ".nan";
  std::string text = shortest(value);
  if (text.find('.') != std::string::npos) return text;
  const auto exponent = text.find('e');
  return text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
}

std::string yaml_numbers(const std::vector<double>& values) { return list(values, yaml_number); }

std::string yaml_text(const std::string& text) {
  return is_plain_yaml(text) ? text : json_text(nlohmann::ordered_json(text), JsonLayout::one_line);
}

std::string yaml_texts(const std::vector<std::string>& texts) { return list(texts, yaml_text); }

std::string ascii(std::string_view utf8) {
  std::string result;
  while (!utf8.empty()) {
    const std::size_t length = std::min(sequence_length(static_cast<unsigned char>(utf8.front())), utf8.size());
    result += plain(utf8.substr(0, length));
    utf8.remove_prefix(length);
  }
  return result;
}

std::string program_text(std::string_view text, std::size_t limit) {
  std::string result = ascii(text);
  for (char& c : result)
    if (c == '"' || c == '\\') c = '\'';
    else if (c == ';' || c == '[' || c == ']') c = ',';
  return result.substr(0, limit);
}

std::string with_crlf(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\n' ? "\r\n" : std::string(1, c);
  return result;
}

std::string xml_escaped(const std::string& text) {
  std::string result;
  for (const char c : text)
    if (c == '&') result += "&amp;";
    else if (c == '<') result += "&lt;";
    else if (c == '>') result += "&gt;";
    else if (c == '"') result += "&quot;";
    else result += c;
  return result;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

std::string in_quotes(std::string_view text) {
  const std::string plain_text = ascii(text.substr(0, 200));
  return "'" + plain_text.substr(0, 40) + (plain_text.size() > 40 ? "..." : "") + "'";
}

}  // namespace posewright::formats
