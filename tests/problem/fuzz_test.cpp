#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "example_files.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

/// Mutations for each good file; POSEWRIGHT_FUZZ_CASES asks for a longer sweep.
int case_count() {
  const char* text = std::getenv("POSEWRIGHT_FUZZ_CASES");
  return text == nullptr ? 3000 : std::atoi(text);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    lines.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

const char* const nasty[] = {
    "~",    "\"",  "'",     "[",     "]",     "{",    "}",       ": ",       "- ",           "&a ", "*a",
    "\n",   "\t",  "1e400", ".nan",  "-1",    "0",    "deg",     "\"\\n\"",  "!!binary x",   "# ",  "? ",
    "|\n",  ">\n", ",",     "%YAML", "---\n", "<<: ", "\"\\0\"", "\xC2\x85", "\xE2\x80\xA8", "@",   "`",
    "...\n"};

void mutate_bytes(std::string& text, Random& random) {
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

void mutate_lines(std::string& text, Random& random) {
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

std::string mutated(std::string text, Random& random) {
  for (int changes = 1 + random.index(4); changes > 0 && !text.empty(); --changes)
    random.index(2) == 0 ? mutate_bytes(text, random) : mutate_lines(text, random);
  return text;
}

bool is_one_line(const std::string& text) {
  for (const char* end : {"\n", "\r", "\v", "\f", "\xC2\x85", "\xE2\x80\xA8", "\xE2\x80\xA9"})
    if (text.find(end) != std::string::npos) return false;
  return true;
}

void sweep(const std::string& good, std::uint64_t seed) {
  int accepted = 0;
  const int cases = case_count();
  for (int i = 0; i < cases; ++i) {
    Random random(seed, std::uint64_t(i));
    const std::string text = mutated(good, random);
    try {
      parse_problem(text, "fuzz.yaml");
      ++accepted;
    } catch (const InputError& error) {
      const std::string what = error.what();
      ASSERT_TRUE(what.starts_with("fuzz.yaml:")) << what << "\ncase " << i << "\n" << text;
      ASSERT_TRUE(is_one_line(what)) << what << "\ncase " << i << "\n" << text;
      ASSERT_LE(error.place().line, std::count(text.begin(), text.end(), '\n') + 1) << what << "\n" << text;
    } catch (const std::exception& error) {
      FAIL() << "case " << i << ": " << error.what() << "\n" << text;
    }
  }
  // Neither everything nor nothing may pass, or the sweep tests little.
  EXPECT_GT(accepted, cases / 100);
  EXPECT_LT(accepted, cases / 2);
}

TEST(FuzzProblem, MutatedSerialFileParsesOrGivesOneLineThatStartsWithTheFile) { sweep(example::serial, 1); }
TEST(FuzzProblem, MutatedCellFileParsesOrGivesOneLineThatStartsWithTheFile) { sweep(example::cell, 3); }
TEST(FuzzProblem, MutatedSixPusFileParsesOrGivesOneLineThatStartsWithTheFile) { sweep(example::six_pus, 2); }

}  // namespace
}  // namespace posewright
