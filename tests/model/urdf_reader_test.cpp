#include "posewright/model/urdf_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/support/random.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

const std::string good = R"(<?xml version="1.0"?>
<robot name="r">
  <link name="base"/>
  <link name="a"/>
  <link name="b"/>
  <link name="c"/>
  <joint name="j1" type="revolute">
    <parent link="base"/><child link="a"/>
    <origin xyz="0 0 1" rpy="0 0 0.5"/><axis xyz="0 0 2"/>
    <limit lower="-1" upper="2" effort="0" velocity="1"/>
  </joint>
  <joint name="f" type="fixed"><parent link="a"/><child link="b"/><origin xyz="0.5 0 0"/></joint>
  <joint name="j2" type="continuous"><parent link="b"/><child link="c"/><axis xyz="0 1 0"/></joint>
</robot>
)";

ChainDescription read(const TemporaryFolder& folder, const std::string& text, const std::string& tip = "") {
  SerialArmSpec arm;
  arm.urdf = folder.write("r.urdf", text);
  if (!tip.empty()) arm.tip = Located<std::string>{tip, 9};
  return read_urdf_chain(arm, {"p.yaml", 3});
}

TEST(UrdfReader, ChainHasJointsLimitsAndMergedFixedJoints) {
  const TemporaryFolder folder;
  const ChainDescription chain = read(folder, good);
  ASSERT_EQ(chain.joints.size(), 2U);
  EXPECT_EQ(chain.coordinates[0].name, "j1");
  EXPECT_EQ(chain.coordinates[0].upper, 2);
  EXPECT_NEAR(chain.coordinates[1].upper, 3.141592653589793, 1e-15);
  EXPECT_NEAR(chain.joints[0].axis.z(), 1, 1e-15) << "the axis is normalised";
  EXPECT_NEAR(chain.joints[1].X_ParentJoint.translation().x(), 0.5, 1e-15) << "the fixed joint is merged";
  EXPECT_EQ(read(folder, good, "a").joints.size(), 1U);
}

TEST(UrdfReader, MassesOfFixedLinksAndSideBranchesGoToTheJointThatCarriesThem) {
  const TemporaryFolder folder;
  std::string text = good;
  const auto weigh = [&](const std::string& link, const std::string& inertial) {
    const std::string empty = "<link name=\"" + link + "\"/>";
    text.replace(text.find(empty), empty.size(), "<link name=\"" + link + "\">" + inertial + "</link>");
  };
  const auto inertial = [](const char* mass, const char* xyz) {
    return "<inertial><origin xyz=\"" + std::string(xyz) + "\"/><mass value=\"" + mass +
           "\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>";
  };
  weigh("base", inertial("50", "0 0 0"));
  weigh("a", inertial("10", "0 0 0.1"));
  weigh("b", inertial("30", "0 0.2 0"));  // fixed to a, 0.5 m along x
  weigh("c", inertial("4", "0 0 0"));
  text.insert(text.find("</robot>"),
              "<link name=\"gripper\">" + inertial("1", "0 0 0") +
                  "</link><joint name=\"g\" type=\"revolute\"><parent link=\"c\"/><child link=\"gripper\"/><origin "
                  "xyz=\"0 0 0.5\"/><axis xyz=\"1 0 0\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" "
                  "velocity=\"1\"/></joint>");
  const ChainDescription chain = read(folder, text, "c");
  ASSERT_EQ(chain.joints.size(), 2U);
  EXPECT_NEAR(chain.joints[0].mass, 40, 1e-12) << "a and b; what the base weighs moves no joint";
  EXPECT_TRUE(chain.joints[0].centre_of_mass.isApprox(
      (10 * Eigen::Vector3d(0, 0, 0.1) + 30 * Eigen::Vector3d(0.5, 0.2, 0)) / 40, 1e-12));
  EXPECT_NEAR(chain.joints[1].mass, 5, 1e-12) << "c and the branch on it";
  EXPECT_TRUE(chain.joints[1].centre_of_mass.isApprox(Eigen::Vector3d(0, 0, 0.1), 1e-12));
}

TEST(UrdfReader, MimicJointFollowsItsMaster) {
  const TemporaryFolder folder;
  std::string text = good;
  text.replace(text.find("<axis xyz=\"0 1 0\"/>"), 19,
               "<axis xyz=\"0 1 0\"/><mimic joint=\"j1\" multiplier=\"-2\" offset=\"0.1\"/>");
  const ChainDescription chain = read(folder, text);
  EXPECT_EQ(chain.coordinates.size(), 1U);
  EXPECT_TRUE(chain.joints[1].mimic);
  EXPECT_EQ(chain.joints[1].multiplier, -2);
}

TEST(UrdfReader, MasterOutsideTheChainIsACoordinateOfItsFollowers) {
  const TemporaryFolder folder;
  std::string text = good;
  const auto follow = [&](const std::string& joint, const char* limit, const char* mimic) {
    text.insert(text.find("</joint>", text.find("<joint name=\"" + joint)), std::string(limit) + mimic);
  };
  follow("j1", "", "<mimic joint=\"motor\" multiplier=\"0.5\" offset=\"0.1\"/>");
  follow("j2", "", "<mimic joint=\"motor\"/>");
  text.insert(text.find("</robot>"),
              "<link name=\"wheel\"/><joint name=\"motor\" type=\"prismatic\"><parent link=\"base\"/><child "
              "link=\"wheel\"/><axis xyz=\"1 0 0\"/><limit lower=\"-1\" upper=\"0.4\" effort=\"0\" "
              "velocity=\"2\"/></joint>");
  const ChainDescription chain = read(folder, text, "c");
  ASSERT_EQ(chain.coordinates.size(), 1U);
  EXPECT_EQ(chain.coordinates[0].name, "motor");
  EXPECT_EQ(chain.coordinates[0].unit, "m");
  EXPECT_EQ(chain.coordinates[0].upper, 0.4);
  EXPECT_FALSE(chain.joints[0].mimic) << "its offset and gear are the coordinate's";
  EXPECT_EQ(chain.joints[0].multiplier, 0.5);
  EXPECT_TRUE(chain.joints[1].mimic);
  EXPECT_EQ(chain.joints[1].coordinate, 0);
}

struct Bad {
  const char* what;
  const char* replace;
  const char* by;
  const char* expected;
};

TEST(UrdfReader, EveryMalformedFileGivesOneLineThatSaysWhere) {
  const std::vector<Bad> table = {
      {"decimal comma", "xyz=\"0 0 1\"", "xyz=\"0 0 1,5\"", "r.urdf:9: origin xyz=\"0 0 1,5\" is malformed"},
      {"garbage number", "rpy=\"0 0 0.5\"", "rpy=\"0 0 0.5x\"", "r.urdf:9: origin rpy"},
      {"two numbers", "xyz=\"0 0 2\"", "xyz=\"0 2\"", "r.urdf:9: axis xyz"},
      {"nan", "lower=\"-1\"", "lower=\"nan\"", "r.urdf:10: limit lower"},
      {"infinite", "upper=\"2\"", "upper=\"inf\"", "r.urdf:10: limit upper"},
      {"empty limits", "upper=\"2\"", "upper=\"-1\"", "r.urdf:7: joint 'j1' has empty limits"},
      {"reversed limits", "upper=\"2\"", "upper=\"-3\"", "joint 'j1' has empty limits"},
      {"no limit", "<limit lower=\"-1\" upper=\"2\" effort=\"0\" velocity=\"1\"/>", "",
       "r.urdf:7: joint 'j1' has no <limit>"},
      {"zero axis", "xyz=\"0 0 2\"", "xyz=\"0 0 0\"", "r.urdf:7: joint 'j1' has a zero axis"},
      {"floating", "type=\"continuous\"", "type=\"floating\"", "joint 'j2' has a type that no arm has"},
      {"planar", "type=\"continuous\"", "type=\"planar\"", "joint 'j2' has a type that no arm has"},
      {"unknown type", "type=\"continuous\"", "type=\"hinge\"", "r.urdf:13: joint 'j2' has the unknown type 'hinge'"},
      {"no type", " type=\"continuous\"", "", "r.urdf:13: joint 'j2' has no type"},
      {"joint without a name", " name=\"j2\"", "", "r.urdf:13: joint has no name"},
      {"link without a name", "<link name=\"c\"/>", "<link/>", "r.urdf:6: link has no name"},
      {"robot without a name", " name=\"r\"", "", "r.urdf:2: <robot> has no name"},
      {"other version", "<robot", "<robot version=\"1.1\"", "r.urdf:2: version '1.1' of URDF is not known"},
      {"unknown parent", "<parent link=\"b\"/>", "<parent link=\"x\"/>",
       "r.urdf:13: parent link 'x' of joint 'j2' is not in the file"},
      {"unknown child", "<child link=\"c\"/>", "<child link=\"cc\"/>",
       "r.urdf:13: child link 'cc' of joint 'j2' is not in the file"},
      {"no child", "<child link=\"c\"/>", "", "r.urdf:13: joint 'j2' has no <child>"},
      {"parent without a link", "<parent link=\"b\"/>", "<parent/>", "r.urdf:13: parent of joint 'j2' has no link"},
      {"no velocity", " velocity=\"1\"", "", "r.urdf:10: limit of joint 'j1' has no velocity"},
      {"no effort", " effort=\"0\"", "", "r.urdf:10: limit of joint 'j1' has no effort"},
      {"no k_velocity", "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><safety_controller soft_lower_limit=\"-1\"/>",
       "r.urdf:13: safety_controller of joint 'j2' has no k_velocity"},
      {"axis without xyz", "<axis xyz=\"0 0 2\"/>", "<axis/>", "r.urdf:7: joint 'j1' has a zero axis"},
      {"mass", "<link name=\"c\"/>", "<link name=\"c\"><inertial><mass value=\"2kg\"/></inertial></link>",
       "r.urdf:6: mass value=\"2kg\" is malformed"},
      {"no link", "<link name=\"base\"/>\n  <link name=\"a\"/>\n  <link name=\"b\"/>\n  <link name=\"c\"/>", "",
       "r.urdf:2: has no <link>"},
      {"material twice", "<link name=\"c\"/>", "<link name=\"c\"/><material name=\"m\"/><material name=\"m\"/>",
       "r.urdf:6: material 'm' is in the file twice"},
      {"two roots",
       "<joint name=\"j2\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/><axis xyz=\"0 1 0\"/></joint>",
       "", "r.urdf:6: neither link 'base' nor 'c' hangs on a joint"},
      {"duplicate joint", "name=\"j2\"", "name=\"j1\"", "r.urdf:13: joint 'j1' is in the file twice"},
      {"duplicate link", "<link name=\"c\"/>", "<link name=\"c\"/><link name=\"a\"/>",
       "r.urdf:6: link 'a' is in the file twice"},
      {"two parents", "<child link=\"c\"/>", "<child link=\"a\"/>", "r.urdf:13: link 'a' is the child of two joints"},
      {"loop", "<child link=\"c\"/>", "<child link=\"base\"/>", "r.urdf:13: link 'base' is its own ancestor"},
      {"not closed", "</robot>", "", "is not well-formed XML"},
      {"other root", "<robot name=\"r\">", "<model name=\"r\">", "is not well-formed XML"},
      {"mimic outside", "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"zz\"/>",
       "mimics 'zz', which is not in the chain"},
      {"mimic without joint", "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic multiplier=\"2\"/>",
       "r.urdf:13: mimic of joint 'j2' has no joint"},
      {"mimic garbage", "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"j1\" multiplier=\"1,5\"/>",
       "mimic multiplier"},
  };
  const TemporaryFolder folder;
  for (const Bad& bad : table) {
    std::string text = good;
    ASSERT_NE(text.find(bad.replace), std::string::npos) << bad.what;
    text.replace(text.find(bad.replace), std::string(bad.replace).size(), bad.by);
    testing::internal::CaptureStderr();
    try {
      read(folder, text);
      ADD_FAILURE() << bad.what << " accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(bad.expected)) << bad.what;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << bad.what;
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << bad.what;
  }
}

TEST(UrdfReader, BadBaseTipAndFilesAreNamed) {
  const TemporaryFolder folder;
  const auto text_of = [&](SerialArmSpec arm) -> std::string {
    try {
      read_urdf_chain(arm, {"p.yaml", 3});
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  SerialArmSpec arm;
  arm.urdf = folder.write("r.urdf", good);
  arm.tip = Located<std::string>{"nowhere", 5};
  EXPECT_THAT(text_of(arm), HasSubstr("p.yaml:5: tip 'nowhere' is not a link of r.urdf; links: a, b, base, c"));
  arm.tip = Located<std::string>{"a", 5};
  arm.base = Located<std::string>{"nobase", 4};
  EXPECT_THAT(text_of(arm), HasSubstr("p.yaml:4: base 'nobase' is not a link"));
  arm.base = Located<std::string>{"b", 4};
  EXPECT_THAT(text_of(arm), HasSubstr("no joint moves between 'b' and 'a'"));
  arm.base = Located<std::string>{"a", 4};
  EXPECT_THAT(text_of(arm), HasSubstr("no joint moves between 'a' and 'a'"));
  std::string branched = good;
  branched.replace(
      branched.find("</robot>"), 8,
      "<link name=\"d\"/><joint name=\"g\" type=\"fixed\"><parent link=\"a\"/><child link=\"d\"/></joint></robot>");
  SerialArmSpec second;
  second.urdf = folder.write("s.urdf", branched);
  EXPECT_THAT(text_of(second), HasSubstr("set robot: tip to one of c, d"));
  second.urdf = folder / "missing.urdf";
  EXPECT_THAT(text_of(second), HasSubstr("cannot be read"));
  second.urdf = folder.write("empty.urdf", "");
  EXPECT_THAT(text_of(second), HasSubstr("is not well-formed XML"));
  second.urdf = folder.path();
  EXPECT_THAT(text_of(second), HasSubstr("is a folder"));
}

TEST(UrdfReader, MutatedFilesAreReadOrRefusedButNeverCrash) {
  const TemporaryFolder folder;
  Random random(4, 0);
  int read_ok = 0, refused = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string text = good;
    for (int k = 1 + random.index(3); k > 0; --k) {
      const auto at = std::size_t(random.index(int(text.size())));
      if (random.index(2) == 0) text.erase(at, std::size_t(1 + random.index(6)));
      else text[at] = char(32 + random.index(95));
    }
    try {
      read(folder, text);
      ++read_ok;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(read_ok, 50);
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace posewright
