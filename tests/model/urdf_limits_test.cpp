#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "posewright/model/urdf_reader.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

/// Two joints: the first as it is given, the second too; a finger beside the chain.
struct Arm {
  std::string first = R"(type="revolute"><limit lower="-2" upper="2.5" effort="0" velocity="1"/>)";
  std::string second = R"(type="revolute"><limit lower="-3" upper="3" effort="0" velocity="1"/>)";
  std::string finger = R"(type="fixed">)";
};

ChainDescription read(const Arm& arm) {
  const TemporaryFolder folder;
  SerialArmSpec spec;
  spec.urdf = folder.write("r.urdf",
                           R"(<robot name="r"><link name="base"/><link name="a"/><link name="tip"/><link name="finger"/>
<joint name="j1" )" + arm.first +
                               R"(<parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
<joint name="j2" )" + arm.second +
                               R"(<parent link="a"/><child link="tip"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="f" )" + arm.finger +
                               R"(<parent link="tip"/><child link="finger"/><axis xyz="0 0 1"/></joint></robot>)");
  spec.tip = Located<std::string>{"tip", 9};
  return read_urdf_chain(spec, {"p.yaml", 3});
}

std::string error_of(const Arm& arm) {
  try {
    read(arm);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string following(double multiplier, double offset, double lower, double upper, double speed = 9) {
  return fmt::format(R"(type="revolute"><mimic joint="j1" multiplier="{}" offset="{}"/>
<limit lower="{}" upper="{}" effort="0" velocity="{}"/>)",
                     multiplier, offset, lower, upper, speed);
}

TEST(UrdfLimits, OfAFollowerEndWhereItsOwnWouldBePassed) {
  Random random(7, 0);
  int narrowed = 0;
  for (int i = 0; i < 200; ++i) {
    const double factor = random.uniform(-3, 3), offset = random.uniform(-1, 1);
    const double lower = random.uniform(-2, 0), upper = lower + random.uniform(0.3, 3);
    for (const bool beside : {false, true}) {
      Arm arm;
      (beside ? arm.finger : arm.second) = following(factor, offset, lower, upper);
      // What may be is what a scan of the joint's own range finds.
      double least = 10, most = -10;
      for (int k = 0; k <= 45000; ++k) {
        const double q = -2 + 1e-4 * k, follower = factor * q + offset;
        if (follower < lower || follower > upper) continue;
        least = std::min(least, q);
        most = std::max(most, q);
      }
      if (most - least < 1e-3) {
        if (most < least) {
          EXPECT_THAT(error_of(arm), HasSubstr("no range is left for joint 'j1'"));
        }
        continue;
      }
      const Coordinate j1 = read(arm).coordinates.front();
      EXPECT_NEAR(j1.lower, least, 1.1e-4);
      EXPECT_NEAR(j1.upper, most, 1.1e-4);
      narrowed += j1.limited_by.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(narrowed, 100);
}

TEST(UrdfLimits, OfAFollowersVelocityAreKept) {
  Arm arm;
  arm.second = following(-2, 0, -9, 9, 1.5);
  EXPECT_DOUBLE_EQ(read(arm).coordinates.front().speed, 0.75);
  arm.second = following(0.5, 0, -9, 9, 1.5);
  EXPECT_DOUBLE_EQ(read(arm).coordinates.front().speed, 1);
}

TEST(UrdfLimits, OfAFollowerThatStandsStillAreAskedOnce) {
  Arm arm;
  arm.second = following(0, 0.7, -0.5, 0.5);
  EXPECT_THAT(error_of(arm), HasSubstr("joint 'j2' is beyond its own limits"));
  arm.second = following(0, 0.4, -0.5, 0.5);
  EXPECT_EQ(read(arm).coordinates.front().upper, 2.5);
}

TEST(UrdfLimits, ThatAFileLeavesOutOfAFollowerBindNothing) {
  Arm arm;
  arm.finger = R"(type="prismatic"><mimic joint="j1"/><limit effort="1" velocity="1"/>)";
  EXPECT_EQ(read(arm).coordinates.front().upper, 2.5);
  arm.finger = R"(type="fixed"><mimic joint="j1"/>)";
  EXPECT_EQ(read(arm).coordinates.front().upper, 2.5);
}

TEST(UrdfLimits, AFullTurnIsOneForFollowersByWholeNumbersOnly) {
  Arm arm;
  arm.first = R"(type="continuous">)";
  const auto follower = [](double factor) {
    return fmt::format(R"(type="continuous"><mimic joint="j1" multiplier="{}"/>)", factor);
  };
  for (const double factor : {1.0, -2.0, 0.5}) {
    arm.second = follower(factor);
    EXPECT_EQ(read(arm).coordinates.front().periodic, factor == std::round(factor)) << factor;
  }
}

std::string soft(double lower, double upper) {
  return fmt::format(R"(<safety_controller k_velocity="10" soft_lower_limit="{}" soft_upper_limit="{}"/>)", lower,
                     upper);
}

TEST(UrdfLimits, SoftOnesBind) {
  Arm arm;
  const std::string hard = arm.first;
  arm.first = hard + soft(-0.5, 0.25);
  const Coordinate j1 = read(arm).coordinates.front();
  EXPECT_EQ(j1.lower, -0.5);
  EXPECT_EQ(j1.upper, 0.25);
  EXPECT_THAT(j1.limited_by, HasSubstr("soft limits"));
  arm.first = hard + soft(-9, 2);
  EXPECT_EQ(read(arm).coordinates.front().lower, -2) << "soft limits do not widen hard ones";
  arm.first = hard + R"(<safety_controller k_velocity="10"/>)";
  EXPECT_EQ(read(arm).coordinates.front().lower, -2) << "0 and 0 is the format's way to have none";
  arm.first = hard + soft(2.6, 2.7);
  EXPECT_THAT(error_of(arm), HasSubstr("r.urdf:2: no range is left for joint 'j1'"));
  arm.first = R"(type="continuous">)" + soft(-100, 100);
  EXPECT_TRUE(read(arm).coordinates.front().periodic);
  arm.first = R"(type="continuous">)" + soft(-1, 1);
  EXPECT_EQ(read(arm).coordinates.front().upper, 1);
  EXPECT_FALSE(read(arm).coordinates.front().periodic);
  arm.first = hard + soft(0, 0);
  arm.first.replace(arm.first.find("soft_upper_limit=\"0\""), 20, "soft_upper_limit=\"0,5\"");
  EXPECT_THAT(error_of(arm), HasSubstr("soft_upper_limit=\"0,5\" is malformed"));
}

TEST(UrdfLimits, SoftOnesOfAFollowerBindItsMaster) {
  Arm arm;
  arm.second = following(2, 0.5, -3, 3) + soft(-0.5, 0.5);
  EXPECT_DOUBLE_EQ(read(arm).coordinates.front().lower, -0.5);
  EXPECT_DOUBLE_EQ(read(arm).coordinates.front().upper, 0.0);
}

TEST(UrdfNames, ThatWouldBreakListsAreRefused) {
  for (const char* name : {"a,b", "a;b", "a&quot;b", "a'b", "a[b]", "#a", " a", "a ", "a&#10;b", "pose", "id", "weight",
                           "load_case", "station"}) {
    const TemporaryFolder folder;
    SerialArmSpec spec;
    spec.urdf = folder.write("r.urdf", fmt::format(R"(<robot name="r"><link name="base"/><link name="tip"/>
<joint name="{}" type="continuous"><parent link="base"/><child link="tip"/></joint></robot>)",
                                                   name));
    try {
      read_urdf_chain(spec, {"p.yaml", 3});
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("r.urdf:2: joint name '")) << name;
    }
  }
}

TEST(UrdfReader, OfTwentyThousandLinksIsReadInAMoment) {
  for (const bool deep : {true, false}) {
    std::string text = "<robot name=\"r\"><link name=\"l0\"/>";
    for (int i = 1; i <= 20000; ++i)
      text += fmt::format(
          "<link name=\"l{0}\"/><joint name=\"j{0}\" type=\"{1}\"><parent link=\"l{2}\"/><child "
          "link=\"l{0}\"/></joint>",
          i, i == 1 ? "continuous" : "fixed", deep || i == 1 ? i - 1 : 1);
    const TemporaryFolder folder;
    SerialArmSpec spec;
    spec.urdf = folder.write("r.urdf", text + "</robot>");
    spec.tip = Located<std::string>{deep ? "l20000" : "l1", 3};
    EXPECT_EQ(read_urdf_chain(spec, {"p.yaml", 3}).joints.size(), 1U);
    // A branch of as many links hangs on the joint.
    spec.tip = Located<std::string>{"l1", 3};
    EXPECT_EQ(read_urdf_chain(spec, {"p.yaml", 3}).joints.size(), 1U);
  }
  std::string many = "<robot name=\"r\"><link name=\"l0\"/>";
  for (int i = 1; i <= 50001; ++i)
    many += fmt::format(
        "<link name=\"l{0}\"/><joint name=\"j{0}\" type=\"fixed\"><parent link=\"l0\"/><child link=\"l{0}\"/></joint>",
        i);
  const TemporaryFolder folder;
  SerialArmSpec spec;
  spec.urdf = folder.write("r.urdf", many + "</robot>");
  EXPECT_THROW(read_urdf_chain(spec, {"p.yaml", 3}), InputError);
}

}  // namespace
}  // namespace posewright
