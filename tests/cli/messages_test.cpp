// What a user reads after a mistake: one line that says all, the line of the file with a caret under the place, and the
// word that was meant.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <sstream>

#include "posewright/support/file.hpp"
#include "posewright/support/near_words.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string urdf = POSEWRIGHT_SOURCE_DIR "/examples/kr270/kr270.urdf";

std::string problem() {
  return "posewright: 1\n"
         "robot: {urdf: \"" +
         urdf +
         "\", base: base_link, tip: flange}\n"
         "measurement:\n"
         "  type: pose\n"
         "  device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}\n"
         "variants: {all: {parameters: auto, nuisance: [\"base.*\"]}}\n"
         "workspace: {joints: {limits: {joint_a1: [-30 deg, 30 deg]}}}\n"
         "design: {poses: 12, criterion: o1, method: exchange, candidates: 100, restarts: 1}\n";
}

std::string with(const std::string& old_word, const std::string& new_word) {
  std::string text = problem();
  text.replace(text.find(old_word), old_word.size(), new_word);
  return text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The text above the caret and its tildes, in characters of one byte.
std::string marked(const std::vector<std::string>& lines) {
  if (lines.size() != 3) return "not three lines";
  const std::size_t begin = lines[2].find('^');
  return begin == std::string::npos ? "no caret" : lines[1].substr(begin, lines[2].size() - begin);
}

TEST(Messages, TheCaretStandsUnderWhatIsWrongAndTheLineIsThatOfTheFile) {
  const TemporaryFolder folder;
  const std::vector<std::array<std::string, 4>> cases = {
      {"measurement:\n", "measurment:\n", "measurment", "unknown key 'measurment' (did you mean 'measurement'?)"},
      {"  type: pose", "  type: psoe", "psoe", "measurement.type is 'psoe' (did you mean 'pose'?); allowed:"},
      {"0.1 mm", "0.1 mmm", "0.1", "measurement.device.noise.position is wrong"},
      {"poses: 12", "poses: -1", "-1", "design.poses"},
      {"{poses: 12", "{poses: 12, pose: 3", "pose", "unknown key 'pose' (did you mean 'poses'?)"},
      {"joint_a1:", "joint_a11:", "joint_a11",
       "'joint_a11' is not a coordinate of this robot (did you mean 'joint_a1'?)"},
      {"tip: flange", "tip: flnage", "flnage", "tip 'flnage' is not a link of kr270.urdf (did you mean 'flange'?)"},
      {"base.*", "bsae.x", "bsae.x", "'bsae.x' matches no parameter of this robot (did you mean 'base.x'?)"},
      {"criterion: o1", "criterion: test_psoe", "test_psoe", "(did you mean 'test_pose'?)"},
      {"method: exchange", "method: exchnage", "exchnage", "unknown method 'exchnage' (did you mean 'exchange'?)"},
  };
  for (const auto& [old_word, new_word, place, message] : cases) {
    folder.write("p.yaml", with(old_word, new_word));
    const ProgramRun run = run_program(folder.path(), {"plan", "p.yaml", "-o", "-", "--poses-csv", "-"});
    EXPECT_EQ(run.exit_code, 2) << new_word;
    const std::vector<std::string> lines = lines_of(run.err);
    ASSERT_EQ(lines.size(), 3U) << run.err;
    EXPECT_THAT(lines[0], HasSubstr(message)) << "the one line comes first";
    EXPECT_THAT(lines[0], testing::StartsWith("posewright: p.yaml:"));
    EXPECT_EQ(marked(lines), place) << run.err;
    const std::size_t bar = lines[1].find(" | ");
    const int number = std::stoi(lines[1].substr(0, bar));
    EXPECT_THAT(lines[0], HasSubstr(":" + std::to_string(number) + ": "));
    EXPECT_EQ(lines[1].substr(bar + 3), lines_of(with(old_word, new_word))[std::size_t(number - 1)]);
  }
}

TEST(Messages, TheCaretCountsCharactersAndLongLinesAreCutAboutIt) {
  const TemporaryFolder folder;
  folder.write("p.yaml", with("{poses: 12", "{\"größe\\u00e4\": 3, poses: 12"));
  const std::vector<std::string> accents = lines_of(run_program(folder.path(), {"observe", "p.yaml"}).err);
  ASSERT_EQ(accents.size(), 3U);
  EXPECT_EQ(accents[2].find('^'), std::string("  8 | design: {").size());
  folder.write("p.yaml", with("{poses: 12", "{candidates: 100, # " + std::string(500, 'x') + "\n  poses: 12"));
  folder.write("q.yaml", with("{poses: 12", "{require: {sigma: {" + std::string(300, 'x') + ": 1 mm}}, psoes: 12"));
  const std::vector<std::string> longest = lines_of(run_program(folder.path(), {"observe", "q.yaml"}).err);
  ASSERT_EQ(longest.size(), 3U);
  EXPECT_LT(longest[1].size(), 120U);
  EXPECT_THAT(longest[1], HasSubstr("…"));
  folder.write("tab.yaml", "posewright: 1\nrobot:\t{urdf: a, bsae: b}\n");
  const std::vector<std::string> tab = lines_of(run_program(folder.path(), {"observe", "tab.yaml"}).err);
  ASSERT_EQ(tab.size(), 3U);
  EXPECT_EQ(marked(tab), "bsae");
}

TEST(Messages, NoSourceIsShownOfWhatIsNoLineOfAFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(lines_of(run_program(folder.path(), {"plan", "none.yaml"}).err).size(), 1U);
  EXPECT_EQ(lines_of(run_program(folder.path(), {"plan", "--poses", "x", "none.yaml"}).err).size(), 1U);
  folder.write("empty.yaml", "");
  EXPECT_EQ(lines_of(run_program(folder.path(), {"plan", "empty.yaml"}).err).size(), 1U);
}

TEST(Messages, AnEmptyValueOfAnOptionIsRefusedAndAFlagHasNone) {
  const TemporaryFolder folder;
  folder.write("p.yaml", problem());
  const ProgramRun run = run_program(folder.path(), {"plan", "p.yaml", "--seed", ""});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--seed is empty; a value is expected"));
  EXPECT_THAT(run_program(folder.path(), {"observe", "p.yaml", "--json"}).err, Not(HasSubstr("is empty")));
}

TEST(Messages, CommandsOptionsAndTheirWordsAreSuggestedIfTheyAreNear) {
  const TemporaryFolder folder;
  folder.write("p.yaml", problem());
  const std::vector<std::pair<std::vector<std::string>, std::string>> near = {
      {{"paln"}, "unknown command 'paln' (did you mean 'plan'?)"},
      {{"plan", "p.yaml", "--criterium", "o1"}, "(did you mean '--criterion'?)"},
      {{"plan", "p.yaml", "--cand", "5"}, "(did you mean '--candidates'?)"},
      {{"plan", "p.yaml", "--criterion", "test_psoe"}, "unknown criterion 'test_psoe' (did you mean 'test_pose'?)"},
      {{"plan", "p.yaml", "--scaling", "nrom"}, "--scaling is 'nrom' (did you mean 'norm'?)"},
      {{"plan", "p.yaml", "--variant", "al"}, "--variant is 'al'"},
      {{"export", "p.yaml", "--to", "moveti"}, "is not a format that is written (did you mean 'moveit'?)"},
      {{"export", "p.yaml", "--to", "kuka_krl"}, "(did you mean 'kuka-krl'?)"},
  };
  for (const auto& [words, message] : near) {
    const ProgramRun run = run_program(folder.path(), words);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(message));
  }
  for (const std::vector<std::string>& words : {std::vector<std::string>{"frobnicate"}, {"plan", "--zzzz"}, {"xy"}}) {
    const ProgramRun run = run_program(folder.path(), words);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, Not(HasSubstr("did you mean")));
  }
}

/// What the program writes to a terminal that is its input, output and error.
std::string on_a_terminal(const TemporaryFolder& folder, std::vector<std::string> words, bool no_colour) {
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    ::setenv("TERM", "xterm", 1);
    if (no_colour) ::setenv("NO_COLOR", "1", 1);
    else ::unsetenv("NO_COLOR");
    words.insert(words.begin(), POSEWRIGHT_PROGRAM);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::filesystem::current_path(folder.path());
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  std::string shown;
  char bytes[4096];
  for (ssize_t n = 0; (n = ::read(terminal, bytes, sizeof bytes)) > 0;) shown.append(bytes, std::size_t(n));
  ::waitpid(child, nullptr, 0);
  ::close(terminal);
  return shown;
}

TEST(Messages, ColourGoesToTerminalsAloneAndNotWhereNoColorIsSet) {
  const TemporaryFolder folder;
  folder.write("bad.yaml", with("robot:", "robto:"));
  folder.write("p.yaml", problem());
  for (const std::vector<std::string>& words : {std::vector<std::string>{"plan", "bad.yaml"},
                                                {"observe", "p.yaml", "--candidates", "40", "--quiet"},
                                                {"plan", "bad.yaml", "--markdown"}}) {
    EXPECT_THAT(on_a_terminal(folder, words, false), HasSubstr("\x1b[1"));
    EXPECT_THAT(on_a_terminal(folder, words, true), Not(HasSubstr("\x1b[")));
    const ProgramRun piped = run_program(folder.path(), words);
    EXPECT_THAT(piped.out + piped.err, Not(HasSubstr("\x1b[")));
  }
}

/// Cells of each row of each table of a Markdown text, rules left out; fails where a row has another number of cells.
std::vector<std::vector<std::vector<std::string>>> markdown_tables(const std::string& text) {
  std::vector<std::vector<std::vector<std::string>>> tables;
  std::string before;
  for (const std::string& line : lines_of(text)) {
    if (line.starts_with('|')) {
      if (!before.starts_with('|')) {
        EXPECT_EQ(before, "") << "an empty line before a table";
        tables.emplace_back();
      }
      std::vector<std::string> cells;
      std::string cell;
      for (std::size_t i = 1; i < line.size(); ++i) {
        if (line[i] == '|' && line[i - 1] != '\\') cells.push_back(cell), cell.clear();
        else cell += line[i];
      }
      if (!tables.back().empty()) {
        EXPECT_EQ(cells.size(), tables.back().front().size()) << line;
      }
      tables.back().push_back(cells);
    } else if (before.starts_with('|')) {
      EXPECT_EQ(line, "") << "an empty line behind a table";
    }
    before = line;
  }
  return tables;
}

TEST(Messages, MarkdownTablesHaveTheCellsOfTheAlignedOnes) {
  const TemporaryFolder folder;
  folder.write("p.yaml", problem());
  const auto words_of = [](std::string text) {
    for (const char* other : {"\\|"})
      for (std::size_t at; (at = text.find(other)) != std::string::npos;) text.replace(at, 2, "!");
    std::replace(text.begin(), text.end(), '|', ' ');
    std::replace(text.begin(), text.end(), '!', '|');
    std::istringstream in(text);
    std::vector<std::string> words;
    for (std::string word; in >> word;)
      if (word != "---" && word != "---:") words.push_back(word);
    return words;
  };
  ASSERT_EQ(run_program(folder.path(), {"plan", "p.yaml", "--proof-time", "0"}).exit_code, 0);
  for (const std::vector<std::string>& words : {std::vector<std::string>{"export"},
                                                {"init", "--camera", "list"},
                                                {"observe", "p.yaml", "--candidates", "40"},
                                                {"evaluate", "p.yaml", "plan.json"},
                                                {"simulate", "p.yaml", "plan.json", "--draws", "20"}}) {
    std::vector<std::string> with_switch = words;
    with_switch.emplace_back("--markdown");
    const ProgramRun aligned = run_program(folder.path(), words), markdown = run_program(folder.path(), with_switch);
    ASSERT_EQ(markdown.exit_code, 0) << markdown.err;
    EXPECT_EQ(words_of(markdown.out), words_of(aligned.out)) << words.front();
    const auto tables = markdown_tables(markdown.out);
    EXPECT_FALSE(tables.empty());
    for (const auto& table : tables) {
      ASSERT_GE(table.size(), 2U);
      for (const std::string& rule : table[1]) EXPECT_TRUE(rule == " --- " || rule == " ---: ") << rule;
    }
  }
  EXPECT_EQ(run_program(folder.path(), {"export", "--markdown", "--json"}).exit_code, 2);
}

/// By its definition, without a table: the fewest operations, tried one after the other.
std::size_t distance_by_definition(const std::string& a, const std::string& b) {
  if (a.empty()) return b.size();
  if (b.empty()) return a.size();
  std::size_t best = std::min(distance_by_definition(a.substr(1), b), distance_by_definition(a, b.substr(1))) + 1;
  best = std::min(best, distance_by_definition(a.substr(1), b.substr(1)) + (a[0] == b[0] ? 0 : 1));
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0])
    best = std::min(best, distance_by_definition(a.substr(2), b.substr(2)) + 1);
  return best;
}

TEST(NearWords, DistanceIsTheFewestChangesOfLetters) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    std::string a, b;
    for (auto* word : {&a, &b})
      for (auto k = random() % 6; k > 0; --k) *word += char('a' + random() % 3);
    EXPECT_EQ(edit_distance(a, b), distance_by_definition(a, b)) << a << " " << b;
    EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
  }
}

TEST(NearWords, OnlyOneNearestWordIsMeant) {
  EXPECT_EQ(nearest_word("posse", {"poses", "design"}), "poses");
  EXPECT_EQ(nearest_word("JOINT_A1", {"joint-a1", "joint-a2"}), "joint-a1");
  EXPECT_EQ(nearest_word("joint_7", {"joint_1", "joint_2"}), "") << "both are as near";
  EXPECT_EQ(nearest_word("rx", {"ry", "z"}), "") << "two letters are too few to be wrong";
  EXPECT_EQ(nearest_word("candidates", {"measurement"}), "");
  EXPECT_EQ(nearest_word(std::string(1000, 'a'), {std::string(999, 'a')}), "");
  EXPECT_EQ(meant_instead("posse", {"poses"}), " (did you mean 'poses'?)");
}

// A process that may have 1.5 GB is told before anything is drawn.
TEST(Messages, MoreCandidatesThanMemoryHoldsAreRefusedBeforeTheyAreDrawn) {
  const TemporaryFolder folder;
  folder.write("p.yaml", problem());
  const std::string program = POSEWRIGHT_PROGRAM;
  const std::string command = "ulimit -v 1500000; '" + program + "' plan '" + (folder.path() / "p.yaml").string() +
                              "' --candidates 9000000 --threads 1 2> '" + (folder.path() / "said").string() + "'";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(
      read_file(folder.path() / "said"),
      testing::MatchesRegex("posewright: 9000000 candidates need up to [0-9.]+ GB of memory, and 1.5 GB is all there "
                            "is; ask for at most [0-9]+\n"));
}

}  // namespace
}  // namespace posewright
