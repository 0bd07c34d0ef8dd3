#include "posewright/support/text_edit.hpp"

#include <gtest/gtest.h>

namespace posewright {
namespace {

TEST(TextEdits, AreMadeInTheOrderOfTheTextAndAtOnePlaceInTheirOwn) {
  EXPECT_EQ(with_edits("PTP XP1", {}), "PTP XP1");
  EXPECT_EQ(with_edits("A1 10,A2 20", {{9, 11, "-90"}, {3, 5, ""}, {0, 0, "; "}, {0, 0, "! "}, {11, 11, "."}}),
            "; ! A1 ,A2 -90.");
}

}  // namespace
}  // namespace posewright
