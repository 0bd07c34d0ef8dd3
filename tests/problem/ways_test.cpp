// Tips of a robot and what instruments say of them: what is read, and one clear line for each kind of nonsense.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/problem/read_problem.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

std::string with_tips(const std::string& robot, const std::string& measurement, const std::string& workspace = "{}") {
  return "posewright: 1\nrobot: {urdf: a.urdf, " + robot + "}\nmeasurement: " + measurement +
         "\nvariants: {v: {parameters: auto}}\nworkspace: " + workspace + "\n";
}

/// An instrument of a list that says so of its tips.
std::string instrument(const std::string& name, const std::string& tips) {
  return "{name: " + name + ", type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}" +
         (tips.empty() ? "" : ", " + tips) + "}";
}

struct BadWays {
  const char* name;
  std::string robot, measurement, workspace;
  int line;
  const char* message;
};
void PrintTo(const BadWays& bad, std::ostream* out) { *out << bad.name; }

class BadTips : public testing::TestWithParam<BadWays> {};

TEST_P(BadTips, GiveOneClearLine) {
  const BadWays& bad = GetParam();
  try {
    parse_problem(with_tips(bad.robot, bad.measurement, bad.workspace), "p.yaml");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_THAT(what, testing::StartsWith("p.yaml:" + std::to_string(bad.line) + ": "));
    EXPECT_THAT(what, HasSubstr(bad.message));
    EXPECT_EQ(what.find('\n'), std::string::npos);
  }
}

const std::string three = "tips: {left: l, right: r, eye: e}";
const std::string all_used = "[" + instrument("a", "of: left, in: eye") + ", " + instrument("b", "of: right") + "]";

const BadWays bad_ways[] = {
    {"UnknownTipSeen", three, "[" + instrument("a", "of: lefd, in: eye") + "]", "{}", 3,
     "of: the robot has no tip 'lefd' (did you mean 'left'?); tips: left, right, eye"},
    {"UnknownTipOfTheFrame", three, "[" + instrument("a", "of: left, in: nose") + "]", "{}", 3,
     "in: the robot has no tip 'nose'; tips: left, right, eye"},
    {"SeesItself", three, "[" + instrument("a", "of: left, in: left") + "]", "{}", 3,
     "in: 'left' is the tip that the instrument sees; another tip, or none for the robot's base"},
    {"TipThatNobodyUses", three, "[" + instrument("a", "of: left") + ", " + instrument("b", "of: right") + "]", "{}", 2,
     "robot.tips: no instrument sees or stands in tip 'eye'; of or in of an instrument, or leave it out"},
    {"TipsOfOneName", "tips: {left: l, left: r}", all_used, "{}", 2, "duplicate key 'left'"},
    {"NoTips", "tips: {}", all_used, "{}", 2, "robot.tips is empty; at least one tip is needed"},
    {"TipNameWithADot", "tips: {l.1: l}", all_used, "{}", 2, "a name without any of"},
    {"TipsAndTip", three + ", tip: l", all_used, "{}", 2, "robot.tips cannot be combined with tip or group"},
    {"InstrumentWithoutTip", three, "[" + instrument("a", "") + "]", "{}", 3,
     "an instrument does not say which tip it sees; of: one of these tips: left, right, eye"},
    {"TipWithoutTips", "tip: l", "[" + instrument("a", "of: left") + "]", "{}", 3,
     "'left' is a tip, and the robot has no tips"},
    {"PlacementThatNobodyUses", "tips: {left: l, eye: e}, placement: {position: [0, 0, 1]}",
     "[" + instrument("a", "of: left, in: eye") + "]", "{}", 2, "robot.placement is of no use"},
    {"BaseThatNobodyUses", "tips: {left: l, eye: e}, base: b", "[" + instrument("a", "of: left, in: eye") + "]", "{}",
     2, "robot.base is of no use"},
    {"Springs", three + ", elastostatic: {compliance: {j: 1e-6}, loads: {a: {force: [0, 0, 1]}}}", all_used, "{}", 2,
     "robot.elastostatic bends an arm with several tips"},
    {"ToolBox", three, all_used, "{tool: {x: [0, 1]}}", 5, "workspace.tool is a box for one tip alone"},
    {"ToolWithoutTip", three, all_used, "{collision: {tool: [{sphere: 0.1}]}}", 5,
     "tool 'tool 1' does not say which tip carries it; tip: one of these tips: left, right, eye"},
    {"ToolOnAnUnknownTip", three, all_used, "{collision: {tool: [{sphere: 0.1, tip: rigth}]}}", 5,
     "the robot has no tip 'rigth' (did you mean 'right'?)"},
    {"ObstacleOnATip", three, all_used, "{collision: {obstacles: [{sphere: 0.1, tip: left}]}}", 5, "rides on a tip"},
    {"ToolOfARobotWithoutTips", "tip: l", instrument("a", ""), "{collision: {tool: [{sphere: 0.1, tip: left}]}}", 5,
     "'left' is a tip, and the robot has no tips"},
};

INSTANTIATE_TEST_SUITE_P(Ways, BadTips, testing::ValuesIn(bad_ways),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(Ways, AreThoseOfTheInstrumentsEachOnce) {
  const Problem problem =
      parse_problem(with_tips(three, "[" + instrument("a", "of: left, in: eye") + ", " + instrument("b", "of: right") +
                                         ", " + instrument("c", "in: eye, of: left") + "]"),
                    "p.yaml");
  const auto& arm = std::get<SerialArmSpec>(problem.robot);
  ASSERT_EQ(arm.ways.size(), 2U);
  EXPECT_EQ(arm.ways[0].in->link.value, "e");
  EXPECT_EQ(arm.ways[0].of.link.value, "l");
  EXPECT_FALSE(arm.ways[1].in.has_value());
  EXPECT_EQ(arm.ways[1].of.link.value, "r");
}

TEST(Ways, OfOneKindAreTheArmFromBaseToTip) {
  for (const std::string& measurement :
       {instrument("a", "of: left, in: eye"),
        "[" + instrument("a", "of: left, in: eye") + ", " + instrument("b", "of: left, in: eye") + "]"}) {
    const Problem problem = parse_problem(with_tips("tips: {left: l, eye: e}", measurement), "p.yaml");
    const auto& arm = std::get<SerialArmSpec>(problem.robot);
    EXPECT_TRUE(arm.ways.empty());
    EXPECT_EQ(arm.base->value, "e");
    EXPECT_EQ(arm.tip->value, "l");
  }
}

TEST(Ways, OfARobotWithOneTipNeedNotNameIt) {
  const Problem problem = parse_problem(with_tips("base: b, tips: {hand: l}", instrument("a", "")), "p.yaml");
  const auto& arm = std::get<SerialArmSpec>(problem.robot);
  EXPECT_EQ(arm.base->value, "b");
  EXPECT_EQ(arm.tip->value, "l");
}

}  // namespace
}  // namespace posewright
