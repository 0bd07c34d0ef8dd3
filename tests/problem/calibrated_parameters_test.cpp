// The parameters file: what is read, and what each thing that is wrong with it says.

#include "posewright/problem/calibrated_parameters.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "example_files.hpp"
#include "tests/kit/mutate.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

const std::string good_parameters = R"(posewright_parameters: 1
variant: geometric
convention: frames
problem: {file: problem.yaml, sha256: "0123"}
# Values in SI.
parameters:
  joint_a1.offset: {value: 0.000123, unit: rad, nominal: 0, sigma: 1.2e-5}
  "b & c.x": {value: -1.5, note: written by hand}
)";

TEST(CalibratedParameters, AreReadWithTheirLines) {
  const CalibratedParameters p = parse_calibrated_parameters(good_parameters, "cal.yaml");
  EXPECT_EQ(p.file, "cal.yaml");
  EXPECT_EQ(p.sha256.size(), 64U);
  EXPECT_EQ(p.variant.value, "geometric");
  EXPECT_EQ(p.variant.line, 2);
  EXPECT_EQ(p.convention, "frames");
  ASSERT_EQ(p.values.size(), 2U);
  EXPECT_EQ(p.values[0].name.value, "joint_a1.offset");
  EXPECT_EQ(p.values[0].name.line, 7);
  EXPECT_EQ(p.values[0].value, 0.000123);
  EXPECT_EQ(p.values[0].unit, "rad");
  EXPECT_EQ(p.values[1].name.value, "b & c.x");
  EXPECT_EQ(p.values[1].value, -1.5);
  EXPECT_EQ(p.values[1].unit, "");
}

TEST(CalibratedParameters, WrongOnesNameLineAndReason) {
  struct {
    const char *from, *to, *message;
  } const cases[] = {
      {"posewright_parameters: 1\n", "", "bad.yaml:1: the file has no key 'posewright_parameters'; it is required"},
      {"parameters: 1", "parameters: 2", "bad.yaml:1: posewright_parameters is '2'; the only known version is 1"},
      {"variant: geometric\n", "", "the file has no key 'variant'"},
      {"convention: frames", "convention: distal", "bad.yaml:3: convention is 'distal'; allowed: frames, dh, mdh"},
      {"value: 0.000123, ", "", "bad.yaml:7: parameters.joint_a1.offset has no key 'value'"},
      {"0.000123", "0.1 deg", "bad.yaml:7: parameters.joint_a1.offset.value is wrong: '0.1 deg' has a unit"},
      {"0.000123", "0,1", "bad.yaml:7: parameters.joint_a1.offset.1 is empty"},
      {"-1.5", ".nan", "bad.yaml:8: "},
      {"\"b & c.x\"", "joint_a1.offset", "bad.yaml:8: duplicate key 'joint_a1.offset'; first given on line 7"},
      {"{value: -1.5, note: written by hand}", "-1.5", "bad.yaml:8: parameters.b & c.x is '-1.5'; a mapping"},
  };
  for (const auto& c : cases) {
    try {
      parse_calibrated_parameters(example::replaced(good_parameters, c.from, c.to), "bad.yaml");
      ADD_FAILURE() << c.to << " was accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(c.message));
    }
  }
}

TEST(FuzzCalibratedParameters, MutatedFileParsesOrGivesOneLineThatStartsWithTheFile) {
  int accepted = 0;
  constexpr int cases = 3000;
  for (int i = 0; i < cases; ++i) {
    Random random(11, std::uint64_t(i));
    const std::string text = mutated(good_parameters, random);
    try {
      parse_calibrated_parameters(text, "fuzz.yaml");
      ++accepted;
    } catch (const InputError& error) {
      const std::string what = error.what();
      ASSERT_TRUE(what.starts_with("fuzz.yaml:")) << what << "\n" << text;
      ASSERT_EQ(what.find('\n'), std::string::npos) << what;
      ASSERT_LE(error.place().line, std::count(text.begin(), text.end(), '\n') + 1) << what;
    } catch (const std::exception& error) {
      FAIL() << "case " << i << ": " << error.what() << "\n" << text;
    }
  }
  EXPECT_GT(accepted, cases / 100);
  EXPECT_LT(accepted, cases * 2 / 3);
}

}  // namespace
}  // namespace posewright
