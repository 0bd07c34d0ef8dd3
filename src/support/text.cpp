#include "posewright/support/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/support/read_number.hpp"

namespace posewright {
namespace {

constexpr std::size_t longest_quote = 80;

unsigned byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// Controls of ASCII and Latin-1 and the line and paragraph separators U+2028, U+2029.
bool is_control(std::string_view sequence) {
  const unsigned first = byte_at(sequence, 0);
  if (sequence.size() == 1) return first < 0x20 || first == 0x7F;
  if (sequence.size() == 2) return first == 0xC2 && byte_at(sequence, 1) < 0xA0;
  return sequence == "\u2028" || sequence == "\u2029";
}

/// Cuts the first character off `text` and adds it, escaped if it is none of a line.
void move_character(std::string_view& text, std::string& to) {
  const std::size_t length = utf8_length(text);
  const std::string_view sequence = text.substr(0, std::max<std::size_t>(length, 1));
  if (length == 0 || is_control(sequence)) {
    for (std::size_t i = 0; i < sequence.size(); ++i) to += fmt::format("\\x{:02x}", byte_at(sequence, i));
  } else {
    to += sequence;
  }
  text.remove_prefix(sequence.size());
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
  const unsigned first = byte_at(text, 0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte_at(text, i) & 0xC0U) != 0x80U) return 0;
  const unsigned second = byte_at(text, 1);
  const bool outside = (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
                       (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F);
  return outside ? 0 : length;
}

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  while (!text.empty()) {
    if (result.size() > longest_quote) return result + "...'";
    move_character(text, result);
  }
  return result + "'";
}

std::string one_line(std::string_view text) {
  std::string result;
  while (!text.empty()) move_character(text, result);
  return result;
}

bool has_control_character(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(utf8_length(text), 1);
    if (is_control(text.substr(0, length))) return true;
    text.remove_prefix(length);
  }
  return false;
}

std::string_view trimmed_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::optional<std::vector<double>> numbers_in(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  std::vector<double> numbers;
  for (std::size_t begin = text.find_first_not_of(blanks); begin != text.npos; begin = text.find_first_not_of(blanks)) {
    text.remove_prefix(begin);
    std::string_view word = text.substr(0, text.find_first_of(blanks));
    text.remove_prefix(word.size());
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    const std::optional<double> value = read_double(word);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    numbers.push_back(*value);
  }
  return numbers;
}

}  // namespace posewright
