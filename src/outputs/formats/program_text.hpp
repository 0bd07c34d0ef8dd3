#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/outputs/joint_targets.hpp"

// How readers of programs look at text: places stay those of the file, so that values are replaced where they stand.

namespace posewright::formats {

inline bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_word(char c) { return is_letter(c) || is_digit(c); }
inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
inline char upper(char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; }
std::string upper(std::string_view text);

/// A reading place in a text.
class Cursor {
 public:
  Cursor(std::string_view text, std::size_t place = 0) : at(place), text_(text) {}

  bool done() const { return at >= text_.size(); }
  char now() const { return done() ? '\0' : text_[at]; }
  void skip_blanks() {
    while (!done() && is_blank(text_[at])) ++at;
  }
  bool take(char c) {
    skip_blanks();
    if (now() != c) return false;
    ++at;
    return true;
  }
  std::string word() {
    skip_blanks();
    std::string result;
    while (is_word(now())) result += text_[at++];
    return result;
  }
  /// As from_chars reads it, + in front too; none if there is no number.
  std::optional<TextNumber> number();
  /// Numbers between brackets, with commas; none if there is anything else.
  std::optional<std::vector<TextNumber>> list(char open, char close);

  std::size_t at;

 private:
  std::string_view text_;
};

/// Lines of a text, without what ends them.
template <class Body>
void for_each_line(std::string_view text, const Body& body) {
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    body(line, begin, text.substr(begin, end - begin));
    begin = end + 1;
  }
}

/// A line up to where its comment begins, outside of text in double quotes.
std::string_view without_comment(std::string_view line, std::string_view mark);

/// The same text with comments as blanks, so that places stay where they are.
std::string blank_comments(std::string text, std::string_view mark);

/// Lines of places that are asked for in ascending order.
class LineCounter {
 public:
  explicit LineCounter(std::string_view text) : text_(text) {}
  int line_at(std::size_t place) {
    for (; at_ < place && at_ < text_.size(); ++at_) line_ += text_[at_] == '\n' ? 1 : 0;
    return line_;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// The word before a place, past blanks and an assignment.
std::string name_before(std::string_view text, std::size_t place);

}  // namespace posewright::formats
