// The URDF of a calibrated arm: its kinematics is the model's with the corrections, and nothing else has changed.

#include "posewright/model/corrected_urdf.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "posewright/model/dh_chain.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "tests/kit/jets.hpp"
#include "tests/kit/mutate.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using Convention = VariantSpec::Convention;

SerialArmSpec arm_of(const fs::path& urdf, const std::string& tip = "") {
  SerialArmSpec arm;
  arm.urdf = urdf;
  if (!tip.empty()) arm.tip = {tip, 0};
  arm.placement.position = {0.3, -0.2, 0.1};
  arm.placement.rpy = {0.2, 0.1, -0.4};
  return arm;
}

std::unique_ptr<TipModel> model_of(const ChainDescription& chain, Convention convention) {
  if (convention == Convention::frames) return std::make_unique<SerialChain>(chain);
  return std::make_unique<DhChain>(
      denavit_hartenberg(chain, convention == Convention::dh ? DhConvention::distal : DhConvention::proximal));
}

/// Every parameter off by up to `size`, but for those whose name `leave` matches.
std::vector<CalibratedValue> random_values(const TipModel& model, double size, const std::string& leave,
                                           std::uint64_t seed) {
  Random random(seed, 0);
  std::vector<CalibratedValue> values;
  for (const Parameter& p : model.parameters()) {
    const double shift = std::regex_match(p.name, std::regex(leave)) ? 0.0 : random.uniform(-size, size);
    values.push_back({p.name, p.unit, p.nominal, p.nominal + shift});
  }
  return values;
}

Eigen::Isometry3d tip_of(const TipModel& model, const std::vector<double>& q,
                         const std::vector<CalibratedValue>& values) {
  std::vector<double> correction;
  for (const CalibratedValue& v : values) correction.push_back(v.correction());
  Eigen::Isometry3d X;
  Twists none;
  model.linearise({q, correction}, {}, X, none, nullptr);
  return X;
}

/// Text with the origins of its joints cut out, and the blanks before them.
std::string without_joint_origins(const std::string& text) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t begin = text.find("<joint"); begin != std::string::npos; begin = text.find("<joint", at)) {
    const std::size_t end = text.find("</joint>", begin);
    result += text.substr(at, begin - at) +
              std::regex_replace(text.substr(begin, end - begin), std::regex("\\s*<origin[^>]*>"), "");
    at = end;
  }
  return result + text.substr(at);
}

/// The written URDF, read again, has the tip of the model with these values; base and what is left out aside.
void expect_same_arm(const SerialArmSpec& arm, Convention convention, double size, std::uint64_t seed) {
  const TemporaryFolder folder;
  const ChainDescription chain = read_urdf_chain(arm, {});
  const auto model = model_of(chain, convention);
  const bool has_tip = !chain.X_LastTip.isApprox(Eigen::Isometry3d::Identity(), 0);
  const std::string leave = has_tip ? "base\\..*|.*\\.gear" : "base\\..*|.*\\.gear|tool\\..*";
  std::vector<CalibratedValue> values = random_values(*model, size, leave, seed);
  const CorrectedUrdf corrected = corrected_urdf(arm, {}, convention, values);
  const std::string old = read_file(arm.urdf);
  EXPECT_EQ(without_joint_origins(corrected.text), without_joint_origins(old));
  EXPECT_NE(corrected.text, old);

  SerialArmSpec written = arm;
  written.urdf = folder.write("written.urdf", corrected.text);
  const SerialChain again(read_urdf_chain(written, {}));
  Random random(seed, 1);
  for (int i = 0; i < 30; ++i) {
    const std::vector<double> q = random_configuration(chain.coordinates, random);
    const Eigen::Isometry3d expected = tip_of(*model, q, values), found = tip_of(again, q, {});
    ASSERT_LT((expected.matrix() - found.matrix()).cwiseAbs().maxCoeff(), 1e-12) << arm.urdf;
  }
  // Once more by nothing: not one byte moves.
  for (CalibratedValue& v : values) v.value = v.nominal;
  EXPECT_EQ(corrected_urdf(written, {}, convention, values).text, corrected.text);
}

/// Mimic and prismatic joints, fixed ones between, origins with one attribute, with none, or not there at all.
const char* const odd_urdf = R"(<?xml version="1.0"?>
<!-- <joint name="a"><origin xyz="9 9 9"/></joint> -->
<robot name="odd">
  <link name="base"><visual><origin xyz="1 2 3" rpy="0 0 0"/><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/><link name="l5"/><link name="side"/><link name="tip"/>
  <transmission name="t"><joint name="a"><origin xyz="7 7 7"/></joint></transmission>
  <joint name='a' type='continuous'>
    <!-- an <origin xyz="8 8 8"/> in a comment, a > too -->
    <parent link='base'/> <child link='l1'/> <axis xyz='0 0 2'/>
  </joint>
  <joint name="between" type="fixed"><parent link="l1"/><child link="l2"/><origin xyz="0.1 0 0.2" rpy="0.3 0 0"/></joint>
  <joint type="prismatic" name="b &amp; c"><parent link="l2"/><child link="l3"/><axis xyz="0.6 0.8 0"/>
    <origin rpy = '0 1.5707963267948966 0'   /><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="follower" type="revolute"><origin
      xyz="0.3 1e-1 0"></origin><parent link="l3"/><child link="l4"/><axis xyz="0 1 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/><mimic joint="a" multiplier="-0.5" offset="0.2"/></joint>
  <joint name="d" type="revolute"><parent link="l4"/><child link="l5"/><origin/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="beside" type="revolute"><parent link="l4"/><child link="side"/><axis xyz="0 1 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/><mimic joint="d"/></joint>
  <joint name="end" type="fixed"><parent link="l5"/><child link="tip"/><origin xyz="0 0 0.25"/></joint>
</robot>
)";

TEST(CorrectedUrdf, OfEveryKindOfArmHasTheCorrectedModelsTip) {
  const TemporaryFolder folder;
  for (const NamedChain& named : named_chains()) {
    const SerialArmSpec arm = arm_of(folder.write(std::string(named.name) + ".urdf", urdf_text(named.joints)));
    for (const Convention convention : {Convention::frames, Convention::dh, Convention::mdh})
      for (const double size : {1e-4, 0.1}) expect_same_arm(arm, convention, size, 3);
  }
}

TEST(CorrectedUrdf, OfMimicPrismaticAndFixedJointsAndOddTextHasTheCorrectedModelsTip) {
  const TemporaryFolder folder;
  const fs::path urdf = folder.write("odd.urdf", odd_urdf);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    expect_same_arm(arm_of(urdf, "tip"), Convention::frames, 0.2, seed);
    expect_same_arm(arm_of(urdf, "l5"), Convention::frames, 0.2, seed);  // ends in a joint that moves
    expect_same_arm(arm_of(urdf, "l4"), Convention::frames, 0.2, seed);  // ends in the mimic joint
  }
}

TEST(CorrectedUrdf, OfTheExampleArmHasTheCorrectedModelsTip) {
  const fs::path urdf = fs::path(POSEWRIGHT_SOURCE_DIR) / "examples/kr270/kr270.urdf";
  for (const Convention convention : {Convention::frames, Convention::dh, Convention::mdh})
    expect_same_arm(arm_of(urdf), convention, 1e-3, 5);
}

TEST(CorrectedUrdf, OfSharedRobotsHasTheCorrectedModelsTip) {
  const fs::path robots = fs::path(POSEWRIGHT_SHARED_DIR) / "robots";
  if (!fs::exists(robots)) GTEST_SKIP() << "the folder of shared robots is absent";
  for (const auto& [file, tip] :
       {std::pair("kuka_kr300_r2700_2/kuka_quantec_support/urdf/kr300_r2700_2.urdf", "tool0"),
        std::pair("abb_irb120_3_58/abb_irb120_support/urdf/irb120_3_58.urdf", "tool0"),
        std::pair("franka_panda/moveit_resources_panda_description/urdf/panda.urdf", "panda_link8"),
        std::pair("ur10/example-robot-data/robots/ur_description/urdf/ur10_robot.urdf", "tool0")})
    for (const Convention convention : {Convention::frames, Convention::dh, Convention::mdh})
      expect_same_arm(arm_of(robots / file, tip), convention, 1e-3, 6);
}

TEST(CorrectedUrdf, OfNominalValuesIsTheFileItself) {
  const TemporaryFolder folder;
  const SerialArmSpec arm = arm_of(folder.write("odd.urdf", odd_urdf), "tip");
  const SerialChain model(read_urdf_chain(arm, {}));
  const CorrectedUrdf same = corrected_urdf(arm, {}, Convention::frames, random_values(model, 0, "", 1));
  EXPECT_EQ(same.text, odd_urdf);
  EXPECT_TRUE(same.left_out.empty());
}

TEST(CorrectedUrdf, LeavesRotationsAsWrittenWhereOnlyAPlaceChanges) {
  const TemporaryFolder folder;
  const SerialArmSpec arm = arm_of(folder.write("odd.urdf", odd_urdf), "tip");
  const std::string text =
      corrected_urdf(arm, {}, Convention::frames, {{"b & c.x", "m", 0, 0.5}, {"end.x", "m", 0, 1}}).text;
  EXPECT_NE(text.find("<origin rpy = '0 1.5707963267948966 0' xyz=\""), std::string::npos) << text;
  const std::string turned = corrected_urdf(arm, {}, Convention::frames, {{"a.offset", "rad", 0, 0.25}}).text;
  EXPECT_NE(turned.find("<joint name='a' type='continuous'>\n    <origin xyz=\"0 0 0\" rpy=\"0 0 0.25\"/>\n"),
            std::string::npos)
      << turned;
}

TEST(CorrectedUrdf, NamesWithItsValueWhatAUrdfCannotSay) {
  const TemporaryFolder folder;
  const fs::path urdf = folder.write("odd.urdf", odd_urdf);
  const std::vector<CalibratedValue> values = {{"base.x", "m", 0.25, 0.5},
                                               {"a.gear", "1", 0, 0.001},
                                               {"d.compliance", "rad/(N·m)", 1e-6, 2e-6},
                                               {"compensator.preload", "N", 10, 12},
                                               {"P1.x", "m", 0, 0.125},
                                               {"tool.z", "m", 0.25, 0.5},
                                               {"b & c.gear", "1", 0, 0},
                                               {"d.offset", "rad", 0, 0.5}};
  const CorrectedUrdf with_tip = corrected_urdf(arm_of(urdf, "tip"), {}, Convention::frames, values);
  const std::vector<std::string> common = {
      "base.x = 0.5 m: the pose of the base is not part of the robot",
      "a.gear = 0.001: a URDF has no gear errors",
      "d.compliance = 2e-06 rad/(N·m): a URDF has no place for it",
      "compensator.preload = 12 N: a URDF has no place for it",
      "P1.x = 0.125 m: a URDF has no place for it",
      "d.offset = 0.5 rad: joint 'beside' outside the chain follows this joint as before"};
  EXPECT_EQ(with_tip.left_out, common);
  EXPECT_NE(with_tip.text.find("<origin xyz=\"0 0 0.5\"/></joint>"), std::string::npos) << with_tip.text;
  std::vector<std::string> more = common;
  more.insert(more.begin() + 1, "tool.z = 0.5 m: no fixed joint ends in link 'l5'");
  EXPECT_EQ(corrected_urdf(arm_of(urdf, "l5"), {}, Convention::frames, values).left_out, more);
}

TEST(CorrectedUrdf, OfADamagedFileThatIsStillReadHasTheCorrectedModelsTip) {
  const TemporaryFolder folder;
  int read = 0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    Random random(21, i);
    const SerialArmSpec arm = arm_of(folder.write("damaged.urdf", mutated(odd_urdf, random)), "tip");
    ChainDescription chain;
    try {
      chain = read_urdf_chain(arm, {});
    } catch (const InputError&) {
      continue;
    }
    const SerialChain model(chain);
    const std::vector<CalibratedValue> values = random_values(model, 0.1, "base\\..*|.*\\.gear|tool\\..*", i);
    SerialArmSpec written = arm;
    try {
      written.urdf = folder.write("written.urdf", corrected_urdf(arm, {}, Convention::frames, values).text);
    } catch (const InputError& error) {
      ASSERT_NE(std::string(error.what()).find("malformed entities"), std::string::npos) << error.what();
      continue;
    }
    const SerialChain again(read_urdf_chain(written, {}));
    const std::vector<double> q = random_configuration(chain.coordinates, random);
    const Eigen::Isometry3d expected = tip_of(model, q, values), found = tip_of(again, q, {});
    const double scale = std::max(1.0, expected.translation().cwiseAbs().maxCoeff());
    ASSERT_LT((expected.matrix() - found.matrix()).cwiseAbs().maxCoeff(), 1e-12 * scale) << read_file(arm.urdf);
    ++read;
  }
  EXPECT_GT(read, 20);
}

TEST(CorrectedUrdf, HasNoDenavitHartenbergParametersWithMimicJoints) {
  const TemporaryFolder folder;
  const SerialArmSpec arm = arm_of(folder.write("odd.urdf", odd_urdf), "tip");
  EXPECT_THROW(corrected_urdf(arm, {}, Convention::dh, {{"a.theta", "rad", 0, 0.1}}), CannotDo);
}

/// A xacro file and what xacro makes of it.
const char* const macro_text = R"(<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <!-- lengths of the data sheet -->
  <xacro:property name="reach" value="0.4"/>
  <xacro:macro name="arm" params="prefix">
    <link name="${prefix}base"/><link name="${prefix}l1"/><link name="${prefix}l2"/><link name="${prefix}tip"/>
    <joint name="${prefix}a" type="revolute"> <origin xyz="0 0 0.3"/> <!-- pan -->
      <parent link="${prefix}base"/><child link="${prefix}l1"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
    <joint name="${prefix}b" type="revolute"><parent link="${prefix}l1"/><child link="${prefix}l2"/>
      <origin rpy="0 0 0" xyz="${reach} 0 0"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
    <joint name="${prefix}end" type="fixed"><origin xyz="0.1 0 ${reach / 2}"/><parent link="${prefix}l2"/><child link="${prefix}tip"/></joint>
    <transmission name="t"><joint name="${prefix}a"/></transmission>
  </xacro:macro>
  <xacro:arm prefix="left_"/>
</robot>
)";

std::string expanded(std::string text, const std::string& prefix) {
  const auto replace = [&](const std::string& what, const std::string& with) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what))
      text.replace(at, what.size(), with);
  };
  replace("<xacro:arm prefix=\"left_\"/>", "");
  replace("<xacro:property name=\"reach\" value=\"0.4\"/>", "");
  replace("<xacro:macro name=\"arm\" params=\"prefix\">", "");
  replace("</xacro:macro>", "");
  replace("${prefix}", prefix);
  replace("${reach / 2}", "0.2");
  replace("${reach}", "0.4");
  return text;
}

TEST(CorrectedXacro, ExpandsToTheCorrectedUrdfAndKeepsCommentsAndMacros) {
  const TemporaryFolder folder;
  SerialArmSpec arm = arm_of(folder.write("arm.xacro", macro_text));
  arm.expanded = std::make_shared<const std::string>(expanded(macro_text, "left_"));
  const SerialChain model(read_urdf_chain(arm, {}));
  const std::vector<CalibratedValue> values = random_values(model, 0.01, "base\\..*|.*\\.gear", 4);
  const CorrectedUrdf urdf = corrected_urdf(arm, {}, Convention::frames, values),
                      macro = corrected_xacro(arm, {}, Convention::frames, values);
  EXPECT_EQ(expanded(macro.text, "left_"), urdf.text);
  EXPECT_EQ(macro.left_out, urdf.left_out);
  EXPECT_NE(macro.text.find("<!-- lengths of the data sheet -->"), std::string::npos);
  EXPECT_NE(macro.text.find("<xacro:arm prefix=\"left_\"/>"), std::string::npos);
  EXPECT_NE(macro.text.find("<joint name=\"${prefix}b\""), std::string::npos);
  // Where nothing was found, not one byte moves.
  std::vector<CalibratedValue> nothing = values;
  for (CalibratedValue& v : nothing) v.value = v.nominal;
  EXPECT_EQ(corrected_xacro(arm, {}, Convention::frames, nothing).text, macro_text);
}

TEST(CorrectedXacro, IsRefusedWhereLinesMakeTwoJointsOrAnotherFileHasThem) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text, const std::string& urdf) -> std::string {
    SerialArmSpec arm = arm_of(folder.write("arm.xacro", text), "left_tip");
    arm.base = {"left_base", 0};
    arm.expanded = std::make_shared<const std::string>(urdf);
    const SerialChain model(read_urdf_chain(arm, {}));
    try {
      corrected_xacro(arm, {}, Convention::frames, random_values(model, 0.01, "base\\..*|.*\\.gear", 4));
    } catch (const CannotDo& error) {
      return error.what();
    }
    return "";
  };
  const std::string left = expanded(macro_text, "left_"), right = expanded(macro_text, "right_");
  EXPECT_NE(refusal("<robot><xacro:include filename=\"x\"/></robot>", left).find("joint 'left_a' is not in this file"),
            std::string::npos);
  const std::string links = right.substr(right.find("<link"), right.find("<transmission") - right.find("<link"));
  std::string both = left;
  both.insert(
      both.find("<transmission"),
      links + "<joint name=\"between\" type=\"fixed\"><parent link=\"left_l2\"/><child link=\"right_base\"/></joint>");
  EXPECT_NE(refusal(macro_text, both).find("joint 'left_a' is made by the same lines as 'right_a'"), std::string::npos);
  std::string block = macro_text;
  block.replace(block.find("<origin xyz=\"0 0 0.3\"/>"), 24, "<xacro:insert_block name=\"origin\"/>");
  EXPECT_NE(refusal(block, left).find("has its origin from a macro"), std::string::npos);
}

}  // namespace
}  // namespace posewright
