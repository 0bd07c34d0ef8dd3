#include "posewright/problem/structure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "posewright/problem/read_problem.hpp"

namespace posewright {
namespace {

std::filesystem::path folder_of_examples() { return std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples"; }

/// Of examples whose robots are among the sources.
std::vector<std::string> problems_of_examples() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_of_examples()))
    if (entry.path().extension() == ".yaml" && entry.path().parent_path().filename() != "cells")
      files.push_back(std::filesystem::relative(entry.path(), folder_of_examples()).string());
  std::sort(files.begin(), files.end());
  return files;
}

std::string bytes_of_problem(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Text up to the design, comments blanked out.
std::string without_comments(std::string text) {
  bool comment = false, quoted = false;
  for (char& c : text) {
    if (c == '"') quoted = !quoted;
    if (c == '\n') comment = quoted = false;
    else if (c == '#' && !quoted) comment = true;
    if (comment) c = ' ';
  }
  return text;
}

/// Numbers that stand alone or before a unit.
const std::regex lone_number(R"(([\[{:, "])(-?\d+(?:\.\d+)?)(?=[ ,\]}"\n]))");

class StructureOf : public testing::TestWithParam<std::string> {};

// Any number of robot, instrument, variants and workspace counts; those of the design and the layout do not.
TEST_P(StructureOf, AProblemHasEachOfItsNumbers) {
  const std::filesystem::path file = folder_of_examples() / GetParam();
  const std::string text = bytes_of_problem(file), plain = without_comments(text);
  const std::string whole = structure_of(read_problem(file));
  const std::size_t design = std::min(plain.find("\ndesign:"), plain.size());
  int changed = 0;
  for (std::sregex_iterator at(plain.begin(), plain.begin() + std::ptrdiff_t(design), lone_number), end; at != end;
       ++at) {
    const std::string value = at->str(2);
    if (at->position(2) < std::ptrdiff_t(plain.find('\n', plain.find("posewright:")))) continue;  // of the format
    if (value == "1" || value == "-1") continue;  // of a direction, whose length does not count
    const std::string other = value.find('.') != std::string::npos ? value + "3" : std::to_string(std::stol(value) + 1);
    std::string edited = text;
    edited.replace(std::size_t(at->position(2)), value.size(), other);
    try {
      EXPECT_NE(structure_of(parse_problem(edited, file)), whole)
          << value << " to " << other << " at " << text.substr(std::size_t(at->position(2)), 30);
      ++changed;
    } catch (const InputError&) {  // a value that is not allowed
    }
  }
  EXPECT_GE(changed, 2);
}

TEST_P(StructureOf, ADesignIsNoPartOfIt) {
  const std::filesystem::path file = folder_of_examples() / GetParam();
  const std::string text = bytes_of_problem(file);
  const std::size_t design = text.find("\ndesign:");
  if (design == std::string::npos) return;
  EXPECT_EQ(structure_of(parse_problem(text.substr(0, design) + "\ndesign: {poses: 77, restarts: 3}\n", file)),
            structure_of(parse_problem(text.substr(0, design) + "\n# a remark\ndesign: {poses: 78}\n", file)));
}

INSTANTIATE_TEST_SUITE_P(Examples, StructureOf, testing::ValuesIn(problems_of_examples()), [](const auto& one) {
  std::string name = one.param;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
});

}  // namespace
}  // namespace posewright
