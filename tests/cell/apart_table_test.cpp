// What tables say of pairs whose distance has a closed form.

#include <gtest/gtest.h>

#include <cmath>

#include "posewright/support/random.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/sliding_arm.hpp"

namespace posewright {
namespace {

// A ball that one joint carries at its full speed towards a sheet: a bound that loses too little says too much.
TEST(ApartTable, SaysNoMoreThanABallHasThatComesAtFullSpeed) {
  Random random(41, 0);
  int told = 0;
  for (int i = 0; i < 20; ++i) {
    const double angle = random.uniform(-2, 2);
    const Block sheet{{0.05, 0.0001, 0.05}, elbow(angle), angle};
    const Workshop shop({sheet}, false);
    for (const BodyPair& pair : shop.scene.pairs) {
      if (shop.scene.bodies[std::size_t(pair.b)].name != "upper" || !shop.scene.bodies[std::size_t(pair.a)].obstacle)
        continue;
      ASSERT_NE(pair.table, nullptr);
      for (int k = 0; k < 500; ++k) {
        // Beyond the range of the table too, where a whole turn or nothing may be told.
        const double q = k % 5 == 0 ? random.uniform(-9, 9) : angle + random.uniform(-0.6, 0.6);
        const double least = pair.table->spare_at_least(shop.scene, pair, std::vector<double>{q, 0, 0.4}, 0.0);
        if (least < 0) continue;
        ++told;
        EXPECT_LE(least, sheet.distance(elbow(q)) - radius - pair.clearance + 1e-5) << i << " at " << q - angle;
      }
    }
  }
  EXPECT_GT(told, 3000);
}

}  // namespace
}  // namespace posewright
