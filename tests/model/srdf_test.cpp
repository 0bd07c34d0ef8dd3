#include "posewright/model/srdf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/model/urdf_reader.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// A rail, three joints, and two ends.
const char* const two_ends = R"(<robot name="r"><link name="world"/><link name="car"/><link name="a"/><link name="b"/>
  <link name="flange"/><link name="finger"/>
  <joint name="rail" type="prismatic"><parent link="world"/><child link="car"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="2" effort="1" velocity="1"/></joint>
  <joint name="j1" type="revolute"><parent link="car"/><child link="a"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="a"/><child link="b"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="end" type="fixed"><parent link="b"/><child link="flange"/><origin xyz="0.3 0 0"/></joint>
  <joint name="grip" type="revolute"><parent link="flange"/><child link="finger"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>)";

const char* const groups = R"(<robot name="r">
  <group name="arm"><chain base_link="car" tip_link="flange"/></group>
  <group name="listed"><joint name="j2"/><joint name="j1"/></group>
  <group name="whole"><group name="arm"/></group>
  <group name="hand"><link name="finger"/></group>
  <group name="circle"><group name="circle"/></group>
  <disable_collisions link1="a" link2="b" reason="Adjacent"/></robot>)";

std::vector<std::string> names_of(const std::string& group) {
  const TemporaryFolder folder;
  SerialArmSpec arm;
  arm.urdf = folder.write("r.urdf", two_ends);
  arm.srdf = {folder.write("r.srdf", groups), 4};
  arm.group = {group, 5};
  std::vector<std::string> names;
  const ChainDescription chain = read_urdf_chain(arm, {"p.yaml", 3});
  for (const Coordinate& c : chain.coordinates) names.push_back(c.name);
  names.push_back(std::to_string(chain.X_LastTip.translation().x()).substr(0, 3));
  return names;
}

std::string refusal(const std::string& group) {
  try {
    names_of(group);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(SrdfGroup, GivesBaseAndTipByItsChainItsJointsOrItsOnlyGroup) {
  EXPECT_THAT(names_of("arm"), testing::ElementsAre("j1", "j2", "0.3"));
  EXPECT_THAT(names_of("whole"), testing::ElementsAre("j1", "j2", "0.3"));
  // The tip of listed joints is the link that the last one moves, not the flange.
  EXPECT_THAT(names_of("listed"), testing::ElementsAre("j1", "j2", "0.0"));
}

TEST(SrdfGroup, ThatGivesNoChainIsRefusedByName) {
  EXPECT_THAT(refusal("arms"), AllOf(HasSubstr("p.yaml:5"), HasSubstr("groups: arm, listed, whole")));
  EXPECT_THAT(refusal("hand"), HasSubstr("neither one chain nor a list of joints"));
  EXPECT_THAT(refusal("circle"), HasSubstr("'circle'"));
}

}  // namespace
}  // namespace posewright
