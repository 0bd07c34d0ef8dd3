// First problem files of robots with several tips: read again, and tried by the determinant of their information.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/init_problem.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"

namespace posewright {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

constexpr const char* made = "made.yaml";

InitFacts humanoid(const std::vector<std::string>& tips, const std::string& base = "") {
  InitFacts facts;
  facts.robot = examples_folder() / "humanoid/humanoid.urdf";
  facts.base = base;
  facts.tips = tips;
  return facts;
}

Observation observed(const Problem& problem, const std::string& variant) {
  ObserveOptions options;
  options.variant = variant;
  options.candidates = 80;
  options.poses = 30;
  return observe_problem(problem, options, Monitor{}).front();
}

std::vector<std::string> names_of(const Problem& problem) {
  std::vector<std::string> names;
  for (const MeasurementSpec& one : *instruments_of(problem.measurement)) names.push_back(one.name);
  return names;
}

TEST(InitTips, ATrackerReadsReflectorsOfItsOwnOnEitherHand) {
  const InitResult result = init_problem(humanoid({"l_hand", "r_hand"}), made, Monitor{});
  EXPECT_THAT(result.tips, ElementsAre("l_hand", "r_hand"));
  EXPECT_EQ(result.joints, 15);  // the waist once, seven of each arm
  const Problem problem = parse_problem(result.text, made, {});
  EXPECT_THAT(names_of(problem), ElementsAre("l_hand", "r_hand"));
  // One tracker: both stations are one place.
  const auto station = [&](std::size_t i) {
    const auto& instrument = (*instruments_of(problem.measurement))[i];
    return std::get<PointsMeasurement>(instrument.instrument).stations.front().placement.position;
  };
  EXPECT_EQ(station(0), station(1));
  const Observation seen = observed(problem, "geometric");
  EXPECT_TRUE(seen.practical.has_value());
  std::vector<std::string> names;
  for (const auto& parameter : seen.parameters) names.push_back(parameter.name);
  EXPECT_THAT(names, AllOf(Contains("l_elbow.offset"), Contains("r_elbow.offset"), Contains("target@r_hand.P3.z")));
}

TEST(InitTips, ACameraInTheHeadIsInOnePlaceForBothBoards) {
  InitFacts facts = humanoid({"l_hand", "r_hand"}, "head_camera");
  facts.camera = true;
  facts.on_hand = false;
  facts.lens = find_camera("realsense-d435");
  const InitResult result = init_problem(facts, made, Monitor{});
  EXPECT_EQ(result.joints, 16);  // two of the neck, seven of each arm
  const Observation seen = observed(parse_problem(result.text, made, {}), "hand_eye");
  EXPECT_TRUE(seen.practical.has_value());
  std::vector<std::string> names;
  for (const auto& parameter : seen.parameters)
    if (parameter.role == Role::interest) names.push_back(parameter.name);
  EXPECT_THAT(names, UnorderedElementsAre("base@head_camera.x", "base@head_camera.y", "base@head_camera.z",
                                          "base@head_camera.rx", "base@head_camera.ry", "base@head_camera.rz"));

  // A required accuracy is that of the parameters that say where the camera is.
  facts.accuracy = 1e-3;
  const Problem required = parse_problem(init_problem(facts, made, Monitor{}).text, made, {});
  ASSERT_EQ(required.design.require.sigma.size(), 1U);
  EXPECT_EQ(required.design.require.sigma.front().pattern.value, "base@head_camera.?");
}

TEST(InitTips, TipsThatAreNoTwoChainsOfOneRobotAreRefused) {
  const auto refusal = [](const InitFacts& facts) -> std::string {
    return message_of<InputError>([&] { init_problem(facts, made, Monitor{}); }, "accepted");
  };
  EXPECT_THAT(refusal(humanoid({"l_hand", "l_hand"})), HasSubstr("--tip 'l_hand' is given twice"));
  EXPECT_THAT(refusal(humanoid({"l_hand", "r_foot"})), HasSubstr("has no link 'r_foot'"));
}

}  // namespace
}  // namespace posewright
