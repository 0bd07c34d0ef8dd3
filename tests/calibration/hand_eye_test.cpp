// Base and tool that explain what an instrument saw, without a start.

#include "posewright/calibration/hand_eye.hpp"

#include <gtest/gtest.h>

#include "posewright/model/rotation_vector.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

Eigen::Vector3d random_vector(Random& random, double size) {
  return size * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}

Eigen::Isometry3d random_pose(Random& random) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = rotation_by(random_vector(random, 1.0));
  X.translation() = random_vector(random, 0.5);
  return X;
}

/// Points on the tip at random poses of a robot, seen from a random place with noise, lengths divided by `scale`.
std::vector<SeenPoints> seen_points(int poses, int points, double noise, double scale, Random& random) {
  const Eigen::Isometry3d base = random_pose(random);
  Eigen::Matrix3Xd on_tip(3, points);
  for (int k = 0; k < points; ++k) on_tip.col(k) = random_vector(random, 0.1);
  std::vector<SeenPoints> seen;
  for (int i = 0; i < poses; ++i) {
    SeenPoints pose{random_pose(random), on_tip};
    for (int k = 0; k < points; ++k)
      pose.points.col(k) = (base * (pose.tip * Eigen::Vector3d(on_tip.col(k))) + random_vector(random, noise)) / scale;
    seen.push_back(std::move(pose));
  }
  return seen;
}

TEST(HandEye, LeavesTheNoiseWhereverTheInstrumentStands) {
  Random random(1, 0);
  for (int draw = 0; draw < 50; ++draw) {
    const int points = 1 + draw % 3;
    const double left = hand_eye(seen_points(40, points, 1e-4, 1.0, random)).rms;
    // Three coordinates of each point less six of the base and three of each point.
    const double expected = 1e-4 * std::sqrt(3.0 - (6.0 + 3 * points) / (40 * points));
    EXPECT_NEAR(left, expected, 0.2 * expected) << draw;
  }
}

TEST(HandEye, FindsOneFactorOnAllLengthsAndPointsThatWereNotSeen) {
  Random random(2, 0);
  for (const double scale : {1e-3, 0.96, 1.0, 39.37}) {
    std::vector<SeenPoints> seen = seen_points(20, 3, 1e-5, scale, random);
    seen[3].points.col(1).setConstant(std::numeric_limits<double>::quiet_NaN());
    const HandEye fit = hand_eye(seen, true);
    EXPECT_NEAR(fit.scale / scale, 1, 1e-4);
    EXPECT_LT(fit.rms, 3e-5);
    if (scale != 1.0) {
      EXPECT_GT(hand_eye(seen).rms, 100 * fit.rms);
    }
  }
}

TEST(HandEye, SeesThatAMirroredInstrumentBelongsToNoBase) {
  Random random(3, 0);
  std::vector<SeenPoints> seen = seen_points(20, 1, 1e-5, 1.0, random);
  for (SeenPoints& pose : seen) pose.points.row(1) = -pose.points.row(1);
  EXPECT_GT(hand_eye(seen).rms, 0.1);
}

TEST(HandEye, OfTooFewPointsIsInfinite) {
  Random random(4, 0);
  EXPECT_FALSE(std::isfinite(hand_eye(seen_points(5, 1, 1e-5, 1.0, random)).rms));
  EXPECT_FALSE(std::isfinite(hand_eye({}).rms));
}

}  // namespace
}  // namespace posewright
