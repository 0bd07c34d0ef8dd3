#include "posewright/support/read_number.hpp"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <string>

namespace posewright {
namespace {

/// Characters at the front that are the word, whatever their case; 0 if they are not.
std::size_t word_at(std::string_view text, std::string_view word) {
  if (text.size() < word.size()) return 0;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (std::tolower(static_cast<unsigned char>(text[i])) != word[i]) return 0;
  return word.size();
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t digits_from(std::string_view text, std::size_t at) {
  while (at < text.size() && is_digit(text[at])) ++at;
  return at;
}

/// Length of "nan", with what may stand behind it in parentheses.
std::size_t nan_length(std::string_view text, std::size_t length) {
  if (length == text.size() || text[length] != '(') return length;
  std::size_t at = length + 1;
  while (at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_')) ++at;
  return at < text.size() && text[at] == ')' ? at + 1 : length;
}

/// Length of the number at the front without its sign; 0 if there is none.
std::size_t number_length(std::string_view text) {
  if (const std::size_t length = word_at(text, "infinity")) return length;
  if (const std::size_t length = word_at(text, "inf")) return length;
  if (const std::size_t length = word_at(text, "nan")) return nan_length(text, length);
  std::size_t end = digits_from(text, 0), digits = end;
  if (end < text.size() && text[end] == '.') {
    const std::size_t behind = digits_from(text, end + 1);
    digits += behind - (end + 1);
    end = behind;
  }
  if (digits == 0) return 0;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    std::size_t exponent = end + 1;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    if (const std::size_t behind = digits_from(text, exponent); behind > exponent) end = behind;
  }
  return end;
}

bool is_zero(std::string_view digits) {
  return digits.substr(0, digits.find_first_of("eE")).find_first_of("123456789") == std::string_view::npos;
}

/// `convert` is std::strtod or std::strtof: both round correctly, and this platform has the locale "C" alone.
template <class Number>
std::from_chars_result read(const char* first, const char* last, Number& value,
                            Number (*convert)(const char*, char**)) {
  const std::string_view text(first, std::size_t(last - first));
  const std::size_t sign = text.starts_with('-') ? 1 : 0, length = number_length(text.substr(sign));
  if (length == 0) return {first, std::errc::invalid_argument};
  const std::string number(text.substr(0, sign + length));
  const char* const end = first + number.size();
  const Number result = convert(number.c_str(), nullptr);
  const bool finite = is_digit(number[sign]) || number[sign] == '.';
  if (finite && (std::isinf(result) || (result == 0 && !is_zero(number)))) return {end, std::errc::result_out_of_range};
  value = result;
  return {end, std::errc()};
}

}  // namespace

std::from_chars_result read_number(const char* first, const char* last, double& value) {
  return read(first, last, value, &std::strtod);
}

std::from_chars_result read_number(const char* first, const char* last, float& value) {
  return read(first, last, value, &std::strtof);
}

}  // namespace posewright
