#include "posewright/blocks/pose_choices.hpp"

#include <gtest/gtest.h>

namespace posewright {
namespace {

TEST(PoseChoices, HaveAKeyOfTheirOwnOrAreConditions) {
  for (const ChoiceKey& key : choice_keys) EXPECT_EQ(choice_key(key.name), &key);
  EXPECT_EQ(choice_key("temperature"), nullptr);
  EXPECT_EQ(choice_key("load"), nullptr);
  EXPECT_EQ(shown_choice("load_case"), "load case");
  EXPECT_EQ(shown_choice("joint_a2.approach"), "joint_a2.approach");
}

TEST(PoseChoices, ThatAreNewerAreNoKeysOfAPoseWithoutThem) {
  // Files of problems that have no list of instruments are as they were.
  EXPECT_TRUE(choice_key("load_case")->always);
  EXPECT_TRUE(choice_key("station")->always);
  EXPECT_FALSE(choice_key("instrument")->always);
}

TEST(PoseChoices, GiveTheLabelOfAName) {
  const PoseChoices choices = {{"station", "A"}, {"temperature", "20"}};
  EXPECT_EQ(label_of(choices, "temperature"), "20");
  EXPECT_EQ(label_of(choices, "load_case"), "");
}

TEST(PoseChoices, OfASideOfArrivalEndInApproach) {
  EXPECT_TRUE(is_approach("joint_a2.approach"));
  EXPECT_FALSE(is_approach("approach"));
}

}  // namespace
}  // namespace posewright
