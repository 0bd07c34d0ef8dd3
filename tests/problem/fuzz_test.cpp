#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "example_files.hpp"
#include "posewright/problem/read_problem.hpp"
#include "tests/kit/mutate.hpp"

namespace posewright {
namespace {

/// Mutations for each good file; POSEWRIGHT_FUZZ_CASES asks for a longer sweep.
int case_count() {
  const char* text = std::getenv("POSEWRIGHT_FUZZ_CASES");
  return text == nullptr ? 3000 : std::atoi(text);
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

TEST(FuzzProblem, MutatedEditsOfKeysParseOrGiveOneLine) {
  const std::vector<KeyEdit> good = {{"measurement.device.noise", "0.2 mm"},
                                     {"measurement.targets", "{P1: [0.1, 0.2, 0.3], P2: [0, 0, 0.1]}"},
                                     {"variants.geometric.parameters.2", "joint_3.*"},
                                     {"workspace.joints.limits.joint_a1", "[-1, 1]"},
                                     {"robot", "{urdf: a.urdf, base: b, tip: t}"}};
  int accepted = 0;
  const int cases = case_count();
  for (int i = 0; i < cases; ++i) {
    Random random(4, std::uint64_t(i));
    KeyEdit edit = good[std::size_t(random.index(int(good.size())))];
    if (random.index(2) == 0) edit.key = mutated(edit.key, random);
    else edit.value = mutated(edit.value, random);
    try {
      parse_problem(example::serial, "fuzz.yaml", {}, {edit});
      ++accepted;
    } catch (const InputError& error) {
      ASSERT_TRUE(is_one_line(error.what())) << error.what() << "\ncase " << i;
    } catch (const std::exception& error) {
      FAIL() << "case " << i << ": " << error.what() << "\n" << edit.key << "=" << edit.value;
    }
  }
  EXPECT_GT(accepted, cases / 100);
  EXPECT_LT(accepted, cases / 2);
}

TEST(FuzzProblem, MutatedSerialFileParsesOrGivesOneLineThatStartsWithTheFile) { sweep(example::serial, 1); }
TEST(FuzzProblem, MutatedCellFileParsesOrGivesOneLineThatStartsWithTheFile) { sweep(example::cell, 3); }
TEST(FuzzProblem, MutatedSixPusFileParsesOrGivesOneLineThatStartsWithTheFile) { sweep(example::six_pus, 2); }

}  // namespace
}  // namespace posewright
