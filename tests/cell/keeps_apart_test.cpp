// Motions whose least distance is known in advance: pairs asked for just less and just more than that.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "posewright/support/random.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/sliding_arm.hpp"

namespace posewright {
namespace {

using Configuration = std::vector<double>;

/// The least value of a distance that changes by no more than `rate` along a motion from 0 to 1, to a hundredth of a
/// millimetre.
double least_on_the_way(const std::function<double(double)>& distance, double rate) {
  constexpr double accuracy = 1e-5;
  constexpr int guesses = 64;
  double least = distance(1.0);
  for (int i = 0; i < guesses; ++i) least = std::min(least, distance(double(i) / guesses));
  for (double t = 0; t < 1;) {
    const double here = distance(t);
    least = std::min(least, here);
    t += (here - least + accuracy) / rate;
  }
  return least;
}

TEST(KeepApart, EndsExactlyWhereTheLeastDistanceOfTheMotionIs) {
  const std::vector<Block> blocks = drawn_blocks(60);
  Workshop shop(blocks);
  ASSERT_EQ(shop.scene.frames->poses_per_configuration(), 2);
  Random random(22, 0);
  int asked = 0;
  for (int i = 0; i < 2000; ++i) {
    BodyPair& pair = shop.scene.pairs[std::size_t(random.index(int(shop.scene.pairs.size())))];
    const Body& obstacle = shop.scene.bodies[std::size_t(pair.a)];
    if (!obstacle.obstacle) continue;
    const bool of_elbow = shop.scene.bodies[std::size_t(pair.b)].name == "upper";
    EXPECT_EQ(pair.table, nullptr);
    const Block& block = blocks[std::size_t(std::stoi(obstacle.name.substr(1)))];
    // One joint, two of them, or all; the other configuration moves elsewhere.
    Configuration from, to;
    const int moving = i % 4;
    for (int k = 0; k < 6; ++k) {
      const bool slide = k % 3 == 2;
      const auto draw = [&] { return slide ? random.uniform(0.3, 0.6) : random.uniform(-3, 3); };
      from.push_back(draw());
      to.push_back(moving < 3 && k % 3 != moving ? from.back() : draw());
    }
    const int pose = random.index(2);
    const double reach[] = {of_elbow ? upper : upper + 0.6, of_elbow ? 0.0 : 0.6, of_elbow ? 0.0 : 1.0};
    double rate = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t place = 3 * std::size_t(pose) + k;
      rate += reach[k] * std::abs(to[place] - from[place]);
    }
    const double least = least_on_the_way(
        [&](double t) {
          const auto q = [&](std::size_t k) {
            const std::size_t place = 3 * std::size_t(pose) + k;
            return from[place] + t * (to[place] - from[place]);
          };
          return block.distance(of_elbow ? elbow(q(0)) : ball(q(0), q(1), q(2))) - radius;
        },
        rate);
    if (!(least > 1e-4)) continue;
    ++asked;
    pair.clearance = least - 2e-5;
    EXPECT_TRUE(keep_apart(shop.scene, {&pair, 1}, pose, from, to)) << i << " pose " << pose;
    pair.clearance = least + motion_resolution + 2e-5;
    EXPECT_FALSE(keep_apart(shop.scene, {&pair, 1}, pose, from, to)) << i << " pose " << pose;
  }
  EXPECT_GT(asked, 1000);
}

/// Blocks inside the circle of the elbow: along their faces it bends towards them, and their corners are what it
/// passes.
TEST(KeepApart, SeesHowFarATurnBendsTowardsAFace) {
  Random random(24, 0);
  std::vector<Block> blocks;
  std::vector<double> angles, halves;
  for (int i = 0; i < 40; ++i) {
    angles.push_back(random.uniform(-1.5, 1.5));
    halves.push_back(random.uniform(0.2, 0.5));
    const double corner = 0.96 * halves.back(), least = random.uniform(0.001, 0.003);
    const Eigen::Vector3d half(0.02, upper * std::sin(corner), 0.1);
    const double face = upper * std::cos(corner) - radius - least;
    const Eigen::Vector3d outward(std::cos(angles.back()), std::sin(angles.back()), 0);
    blocks.push_back({half, Eigen::Vector3d(shoulder_x, shoulder_y, 0) + (face - half.x()) * outward, angles.back()});
  }
  Workshop shop(blocks);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto pair = std::ranges::find_if(shop.scene.pairs, [&](const BodyPair& of) {
      return shop.scene.bodies[std::size_t(of.a)].name == fmt::format("b{}", i) &&
             shop.scene.bodies[std::size_t(of.b)].name == "upper";
    });
    ASSERT_NE(pair, shop.scene.pairs.end());
    const auto distance = [&](double t) {
      return blocks[i].distance(elbow(angles[i] + (2 * t - 1) * halves[i])) - radius;
    };
    const double least = least_on_the_way(distance, 2 * halves[i] * upper);
    ASSERT_GT(std::min(distance(0.0), distance(1.0)), least + 0.001);
    const Configuration from{angles[i] - halves[i], 0, 0.4, 0, 0, 0.4}, to{angles[i] + halves[i], 0, 0.4, 0, 0, 0.4};
    pair->clearance = least - 2e-5;
    EXPECT_TRUE(keep_apart(shop.scene, {&*pair, 1}, 0, from, to)) << i;
    pair->clearance = least + motion_resolution + 2e-5;
    EXPECT_FALSE(keep_apart(shop.scene, {&*pair, 1}, 0, from, to)) << i;
  }
}

/// Thin sheets across the way of the ball where no point of the arm is faster: nothing is left of what a step may take.
TEST(KeepApart, SeesWhatTheBallPassesAtFullSpeed) {
  Random random(23, 0);
  std::vector<Block> sheets;
  std::vector<double> angles;
  for (int i = 0; i < 60; ++i) {
    angles.push_back(random.uniform(-1.5, 1.5));
    sheets.push_back({{0.05, 0.0001, 0.05}, ball(angles.back(), 0, 0.6), angles.back()});
    if (i % 2 == 0) continue;
    sheets.back() = {{0.0001, 0.05, 0.05}, ball(angles.back(), 0, 0.45), angles.back()};
  }
  Workshop shop(sheets);
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const auto of_ball = [&](const BodyPair& pair) {
      return shop.scene.bodies[std::size_t(pair.a)].name == fmt::format("b{}", i) &&
             shop.scene.bodies[std::size_t(pair.b)].tool;
    };
    const auto pair = std::ranges::find_if(shop.scene.pairs, of_ball);
    ASSERT_NE(pair, shop.scene.pairs.end());
    const bool turning = i % 2 == 0;
    for (int k = 0; k < 8; ++k) {
      const double before = random.uniform(0.05, 1), after = random.uniform(0.05, 1);
      Configuration from{angles[i], 0, 0.6}, to = from;
      if (turning) from[0] -= before, to[0] += after;
      else from[2] = 0.45 - 0.15 * before, to[2] = 0.45 + 0.15 * after;
      from.insert(from.end(), 3, 0.4);
      to.insert(to.end(), 3, 0.4);
      EXPECT_FALSE(keep_apart(shop.scene, {&*pair, 1}, 0, from, to)) << i << " " << k;
      std::rotate(from.begin(), from.begin() + 3, from.end());
      std::rotate(to.begin(), to.begin() + 3, to.end());
      EXPECT_FALSE(keep_apart(shop.scene, {&*pair, 1}, 1, from, to)) << i << " " << k;
      EXPECT_TRUE(keep_apart(shop.scene, {&*pair, 1}, 0, from, to)) << i << " " << k;
    }
  }
}

}  // namespace
}  // namespace posewright
