#include "source_excerpt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <tuple>
#include <utility>
#include <vector>

#include "posewright/support/text.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

constexpr std::size_t most_shown = 100, most_before = 40;  // characters of a line
constexpr std::size_t longest_line = 1'000'000;            // bytes; what is longer was not written by a person

/// Without a note that the file is an input; empty if there is no such line.
std::string line_of(const SourcePlace& place) {
  std::error_code code;
  if (place.line < 1 || !std::filesystem::is_regular_file(place.file, code)) return {};
  std::ifstream in(place.file, std::ios::binary);
  std::string line;
  for (int number = 0; number < place.line; ++number)
    if (!std::getline(in, line) || line.size() > longest_line) return {};
  if (place.line == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
  return line;
}

/// The characters of a line, each as it is shown: tabs are blanks, what is no text a mark.
std::vector<std::string> characters(std::string_view line) {
  std::vector<std::string> result;
  while (!line.empty()) {
    const std::size_t length = std::max<std::size_t>(utf8_length(line), 1);
    std::string one(line.substr(0, length));
    if (one == "\t" || one == "\r") one = " ";
    else if (utf8_length(one) == 0 || has_control_character(one)) one = "?";
    result.push_back(std::move(one));
    line.remove_prefix(length);
  }
  return result;
}

/// Position of a quoted text of the message in the line, in bytes; npos if none occurs.
std::pair<std::size_t, std::size_t> quoted_in(const std::string& line, const std::string& message) {
  for (std::size_t begin = message.find('\''); begin != std::string::npos;) {
    const std::size_t end = message.find('\'', begin + 1);
    if (end == std::string::npos) break;
    const std::string word = message.substr(begin + 1, end - begin - 1);
    const std::size_t at = word.empty() ? std::string::npos : line.find(word);
    if (at != std::string::npos) return {at, word.size()};
    begin = message.find('\'', end + 1);
  }
  return {std::string::npos, 0};
}

/// Bytes of the word that begins at `at`: a quoted text, else up to what ends a word in YAML, CSV and JSON.
std::size_t word_length(const std::string& line, std::size_t at) {
  if (at >= line.size()) return 1;
  if (const char quote = line[at]; quote == '"' || quote == '\'') {
    const std::size_t end = line.find(quote, at + 1);
    return end == std::string::npos ? line.size() - at : end + 1 - at;
  }
  const std::size_t end = std::min(line.find_first_of(" \t\r,:;{}[]<>#\"", at), line.size());
  return std::max<std::size_t>(end - at, 1);
}

struct Mark {
  std::size_t begin = 0, length = 1;  // characters
};

Mark mark_of(const std::string& line, const InputError& error) {
  std::size_t at = std::string::npos, length = 0;
  if (error.place().column > 0) {
    at = 0;
    for (int i = 1; i < error.place().column && at < line.size(); ++i)
      at += std::max<std::size_t>(utf8_length(std::string_view(line).substr(at)), 1);
    length = word_length(line, at);
  } else {
    std::tie(at, length) = quoted_in(line, error.what());
  }
  if (at == std::string::npos) {
    at = std::min(line.find_first_not_of(" \t"), line.size());
    length = line.find_last_not_of(" \t\r") + 1 - at;
  }
  const std::string_view view = line;
  return {characters(view.substr(0, at)).size(), std::max<std::size_t>(characters(view.substr(at, length)).size(), 1)};
}

}  // namespace

std::string source_excerpt(const InputError& error) {
  const std::string line = line_of(error.place());
  if (line.find_first_not_of(" \t\r") == std::string::npos) return {};
  std::vector<std::string> shown = characters(line);
  Mark mark = mark_of(line, error);
  if (shown.size() > most_shown && mark.begin > most_before) {
    const std::size_t cut = std::min(mark.begin - most_before, shown.size() - most_shown);
    shown.erase(shown.begin(), shown.begin() + std::ptrdiff_t(cut));
    mark.begin -= cut;
    shown.front() = "…";
  }
  if (shown.size() > most_shown) {
    shown.resize(most_shown);
    shown.back() = "…";
  }
  while (!shown.empty() && shown.back() == " ") shown.pop_back();
  mark.length = std::max<std::size_t>(std::min(mark.length, shown.size() - std::min(mark.begin, shown.size())), 1);
  const bool colour = has_colour(stderr);
  const std::string number = std::to_string(error.place().line), margin(number.size(), ' ');
  std::string text;
  for (const std::string& character : shown) text += character;
  return fmt::format("  {} | {}\n  {} | {}{}^{}{}\n", number, text, margin, std::string(mark.begin, ' '),
                     colour ? "\x1b[1;31m" : "", std::string(mark.length - 1, '~'), colour ? "\x1b[0m" : "");
}

}  // namespace posewright::cli
