#include "program_text.hpp"

#include <charconv>
#include <cmath>

namespace posewright::formats {

std::string upper(std::string_view text) {
  std::string result;
  for (const char c : text) result += upper(c);
  return result;
}

std::optional<TextNumber> Cursor::number() {
  skip_blanks();
  std::size_t begin = at, end = at;
  while (end < text_.size() &&
         (is_digit(text_[end]) || std::string_view("+-.eE").find(text_[end]) != std::string_view::npos))
    ++end;
  const char* first = text_.data() + begin + (begin < end && text_[begin] == '+' ? 1 : 0);
  TextNumber result{begin, end, 0};
  const auto [stop, code] = std::from_chars(first, text_.data() + end, result.value);
  if (code != std::errc() || stop != text_.data() + end || !std::isfinite(result.value)) return std::nullopt;
  at = end;
  return result;
}

std::optional<std::vector<TextNumber>> Cursor::list(char open, char close) {
  const std::size_t start = at;
  std::vector<TextNumber> result;
  if (!take(open)) return std::nullopt;
  do {
    const auto value = number();
    if (!value) break;
    result.push_back(*value);
    if (take(close)) return result;
  } while (take(','));
  at = start;
  return std::nullopt;
}

std::string_view without_comment(std::string_view line, std::string_view mark) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (!quoted && line.substr(i).starts_with(mark)) return line.substr(0, i);
  }
  return line;
}

std::string blank_comments(std::string text, std::string_view mark) {
  std::vector<std::pair<std::size_t, std::size_t>> gone;
  for_each_line(text, [&](int, std::size_t begin, std::string_view line) {
    const std::size_t kept = without_comment(line, mark).size();
    gone.emplace_back(begin + kept, begin + line.size());
  });
  for (const auto& [begin, end] : gone)
    std::fill(text.begin() + std::ptrdiff_t(begin), text.begin() + std::ptrdiff_t(end), ' ');
  return text;
}

std::string name_before(std::string_view text, std::size_t place) {
  std::size_t end = place;
  while (end > 0 && (is_blank(text[end - 1]) || text[end - 1] == '=' || text[end - 1] == ':')) --end;
  std::size_t begin = end;
  while (begin > 0 && is_word(text[begin - 1])) --begin;
  return std::string(text.substr(begin, end - begin));
}

}  // namespace posewright::formats
