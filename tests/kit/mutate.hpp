#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "posewright/support/random.hpp"

/// Seeded mutation of good input files, for tests of parsers.
namespace posewright {

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    lines.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return lines;
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

inline const char* const nasty[] = {
    "~",    "\"",  "'",     "[",     "]",     "{",    "}",       ": ",       "- ",           "&a ", "*a",
    "\n",   "\t",  "1e400", ".nan",  "-1",    "0",    "deg",     "\"\\n\"",  "!!binary x",   "# ",  "? ",
    "|\n",  ">\n", ",",     "%YAML", "---\n", "<<: ", "\"\\0\"", "\xC2\x85", "\xE2\x80\xA8", "@",   "`",
    "...\n"};

inline void mutate_bytes(std::string& text, Random& random) {
  const auto place = std::size_t(random.index(int(text.size())));
  switch (random.index(4)) {
    case 0:
      text[place] = char(random.index(256));
      break;
    case 1:
      text[place] = char(32 + random.index(95));
      break;
    case 2:
      text.erase(place, 1 + std::size_t(random.index(20)));
      break;
    default:
      text.insert(place, nasty[random.index(int(std::size(nasty)))]);
  }
}

inline void mutate_lines(std::string& text, Random& random) {
  std::vector<std::string> lines = lines_of(text);
  const auto pick = [&] { return random.index(int(lines.size())); };
  const int from = pick();
  const int to = pick();
  switch (random.index(4)) {
    case 0:
      lines.erase(lines.begin() + from);
      break;
    case 1:
      lines.insert(lines.begin() + to, std::string(lines[std::size_t(from)]));
      break;
    case 2:
      std::swap(lines[std::size_t(from)], lines[std::size_t(to)]);
      break;
    default: {  // swap what stands after the colons
      std::string& a = lines[std::size_t(from)];
      std::string& b = lines[std::size_t(to)];
      const auto colon_a = a.find(':');
      const auto colon_b = b.find(':');
      if (from == to || colon_a == std::string::npos || colon_b == std::string::npos) return;
      const std::string tail = a.substr(colon_a);
      a.replace(colon_a, std::string::npos, b.substr(colon_b));
      b.replace(colon_b, std::string::npos, tail);
    }
  }
  text = joined(lines);
}

/// A good file with one to four changes to its bytes or lines.
inline std::string mutated(std::string text, Random& random) {
  for (int changes = 1 + random.index(4); changes > 0 && !text.empty(); --changes)
    random.index(2) == 0 ? mutate_bytes(text, random) : mutate_lines(text, random);
  return text;
}

}  // namespace posewright
