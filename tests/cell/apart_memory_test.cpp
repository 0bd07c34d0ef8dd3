// Verdicts on states one after another, by distances in closed form: nothing that was found before may stand for them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "posewright/cell/collision.hpp"
#include "posewright/support/random.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/sliding_arm.hpp"

namespace posewright {
namespace {

using Configuration = std::vector<double>;

/// Smallest distance of the two balls from any block, at all configurations of a pose.
double room(const std::vector<Block>& blocks, const Configuration& q) {
  double least = 1e9;
  for (std::size_t k = 0; k < q.size(); k += 3)
    for (const Block& block : blocks)
      least = std::min(
          {least, block.distance(elbow(q[k])) - radius, block.distance(ball(q[k], q[k + 1], q[k + 2])) - radius});
  return least;
}

TEST(ApartMemory, GivesTheVerdictOfDistancesAtEveryStepOfAWalk) {
  for (const bool two : {false, true}) {
    const std::vector<Block> blocks = drawn_blocks(20), others = {blocks.rbegin(), blocks.rbegin() + 12};
    const Workshop shop(blocks, two), another({blocks.begin(), blocks.begin() + 12}, two), third(others, two);
    const Collision collision(shop.problem, *shop.model), fewer(another.problem, *another.model),
        elsewhere(third.problem, *third.model);
    Random random(31, 0);
    int hit = 0, free = 0;
    Configuration q;
    for (int i = 0; i < 6000; ++i) {
      const int steps = i % 12;
      if (steps == 0) q.assign(two ? 6 : 3, 0.0);
      for (std::size_t k = 0; k < q.size(); ++k) {
        const double lower = k % 3 == 2 ? 0.3 : -3, upper_limit = k % 3 == 2 ? 0.6 : 3;
        const double step = std::pow(0.5, steps);
        q[k] = steps == 0 ? random.uniform(lower, upper_limit)
                          : std::clamp(q[k] + random.uniform(-step, step), lower, upper_limit);
      }
      const double spare = room(blocks, q) - 0.001 - motion_resolution;
      if (std::abs(spare) > 1e-5) {
        EXPECT_EQ(collision.violation(q) >= 0, spare < 0) << i << (two ? " two" : " one");
        (spare < 0 ? hit : free) += 1;
      }
      // Of other cells at the same state now and then, as places for a robot are compared.
      if (i % 40 > 2) continue;
      const double spare_first = room({blocks.begin(), blocks.begin() + 12}, q) - 0.001 - motion_resolution;
      const double spare_other = room(others, q) - 0.001 - motion_resolution;
      if (std::abs(spare_first) > 1e-5) {
        EXPECT_EQ(fewer.violation(q) >= 0, spare_first < 0) << i;
      }
      if (std::abs(spare_other) > 1e-5) {
        EXPECT_EQ(elsewhere.violation(q) >= 0, spare_other < 0) << i;
      }
    }
    EXPECT_GT(hit, 500);
    EXPECT_GT(free, 500);
  }
}

// A ball that a joint carries at its full speed towards a sheet: what a pair has to spare is just used up.
TEST(ApartMemory, LastsNoLongerThanWhatThereWasToSpare) {
  Random random(32, 0);
  for (int i = 0; i < 40; ++i) {
    const double angle = random.uniform(-1.5, 1.5);
    const bool turning = i % 2 == 0;
    Block sheet{{0.05, 0.0001, 0.05}, ball(angle, 0, 0.6), angle};
    if (!turning) sheet = {{0.0001, 0.05, 0.05}, ball(angle, 0, 0.5), angle};
    const double met = turning ? angle : 0.5, before = random.uniform(0.02, 0.15);
    // Alone, and as either configuration of a pose whose other one is away from the sheet.
    for (const int place : {-1, 0, 1}) {
      const Workshop shop({sheet}, place >= 0);
      const Collision collision(shop.problem, *shop.model);
      const auto hits = [&](double moving) {
        Configuration q = turning ? Configuration{moving, 0, 0.6} : Configuration{angle, 0, moving};
        if (place >= 0) q.insert(place == 0 ? q.end() : q.begin(), {2.5, 0.5, 0.4});
        return collision.violation(q) >= 0;
      };
      ASSERT_FALSE(hits(met - before));
      // Once more, as the memory looks further ahead where states are near each other.
      ASSERT_FALSE(hits(met - before + 0.001));
      EXPECT_TRUE(hits(met)) << i << " at " << place;
    }
  }
}

}  // namespace
}  // namespace posewright
