// Inverse kinematics of six-axis arms against their forward kinematics.

#include "posewright/model/arm_inverse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr double right = std::numbers::pi / 2;

ChainJoint joint(double x, double y, double z, const Eigen::Vector3d& axis) {
  ChainJoint j;
  j.X_ParentJoint = Eigen::Translation3d(x, y, z);
  j.axis = axis;
  return j;
}

/// An arm of the usual kind, upright at zero joints.
ChainDescription arm(double rounding = 0) {
  const Eigen::Vector3d X = Eigen::Vector3d::UnitX(), Y = Eigen::Vector3d::UnitY(), Z = Eigen::Vector3d::UnitZ();
  ChainDescription chain;
  chain.joints = {joint(0, 0, 0.5, -Z),       joint(0.3, 0.02, 0.2, Y), joint(0, 0, 1.1, Y),
                  joint(0.4, -0.02, 0.1, -X), joint(0.7, 0, 0, Y),      joint(0.2, 0, 0, -X)};
  for (int i = 0; i < 6; ++i) {
    ChainJoint& j = chain.joints[std::size_t(i)];
    j.coordinate = i;
    j.X_ParentJoint = j.X_ParentJoint * Eigen::AngleAxisd(rounding, Y);
  }
  chain.coordinates.resize(6);
  chain.X_LastTip = Eigen::Translation3d(0.05, 0.02, 0.1) * Eigen::AngleAxisd(0.7, Y);
  return chain;
}

/// An arm with three parallel axes, as Universal Robots builds them.
ChainDescription parallel_arm() {
  const Eigen::Vector3d Y = Eigen::Vector3d::UnitY(), Z = Eigen::Vector3d::UnitZ();
  ChainDescription chain;
  chain.joints = {joint(0, 0, 0.1273, Z),       joint(0, 0.22, 0, Y),     joint(-0.612, -0.17, 0, Y),
                  joint(-0.5723, 0.1139, 0, Y), joint(0, 0, -0.1157, -Z), joint(0, 0.0922, 0, Y)};
  for (int i = 0; i < 6; ++i) chain.joints[std::size_t(i)].coordinate = i;
  chain.coordinates.resize(6);
  chain.X_LastTip = Eigen::Translation3d(0.05, 0.02, 0.1) * Eigen::AngleAxisd(0.7, Y);
  return chain;
}

ArmInverse::Joints random_joints(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> any(-3, 3);
  ArmInverse::Joints q{};
  for (double& value : q) value = any(generator);
  return q;
}

double distance(const ArmInverse::Joints& a, const ArmInverse::Joints& b) {
  double most = 0;
  for (std::size_t i = 0; i < 6; ++i)
    most = std::max(most, std::abs(std::remainder(a[i] - b[i], 2 * std::numbers::pi)));
  return most;
}

TEST(ArmInverse, FindsTheJointsThatTheTipWasPutByAndPutsItThereWithAllOthers) {
  // 4 µrad is what 1.5708 differs from a right angle.
  for (const ChainDescription& chain : {arm(), arm(4e-6), parallel_arm()}) {
    const ArmInverse inverse(chain);
    std::mt19937_64 generator(1);
    std::vector<ArmBranch> branches;
    int missed = 0;
    for (int k = 0; k < 20000; ++k) {
      const ArmInverse::Joints q = random_joints(generator);
      const Eigen::Isometry3d X = inverse.tip(q);
      inverse.solve(X, branches);
      double nearest = 10;
      for (const ArmBranch& branch : branches) {
        nearest = std::min(nearest, distance(branch.q, q));
        ASSERT_LT((inverse.tip(branch.q).matrix() - X.matrix()).cwiseAbs().maxCoeff(), 1e-9);
        ASSERT_TRUE(&branch == &branches.front() || distance(branch.q, branches.front().q) > 1e-6);
      }
      missed += nearest < 1e-6 ? 0 : 1;
      ASSERT_LE(branches.size(), 8U);
    }
    EXPECT_LT(missed, 20) << "near a singularity alone";
  }
}

TEST(ArmInverse, SaysWhereTheWristIs) {
  const ArmInverse inverse(arm());
  std::vector<ArmBranch> branches;
  const auto branch_of = [&](const ArmInverse::Joints& q) {
    inverse.solve(inverse.tip(q), branches);
    for (const ArmBranch& branch : branches)
      if (distance(branch.q, q) < 1e-6) return branch;
    ADD_FAILURE() << "not found";
    return ArmBranch{};
  };
  const ArmBranch usual = branch_of({0.2, 0.1, 0.2, 0.3, 0.5, 0.1});
  EXPECT_FALSE(usual.behind_base);
  EXPECT_FALSE(usual.behind_arm);
  EXPECT_EQ(std::count_if(branches.begin(), branches.end(), [](const ArmBranch& b) { return b.behind_arm; }),
            long(branches.size()) / 2);
  EXPECT_TRUE(branch_of({0.2, -1.3, -0.5, 0.3, 0.5, 0.1}).behind_base) << "leaning back over the base";
  EXPECT_TRUE(branch_of({0.2, 0.9, -2.2, 0.3, 0.5, 0.1}).behind_arm) << "forearm bent back";
}

TEST(ArmInverse, RefusesOtherKindsOfArmsWithTheReason) {
  const auto refused = [](ChainDescription chain) -> std::string {
    try {
      const ArmInverse inverse(chain);
    } catch (const CannotDo& error) {
      return error.what();
    }
    return "";
  };
  ChainDescription offset = arm(), skew = arm(), slides = arm(), five = arm();
  offset.joints[4].X_ParentJoint.translation().z() = 0.01;
  skew.joints[2].axis = Eigen::AngleAxisd(right / 9, Eigen::Vector3d::UnitX()) * skew.joints[2].axis;
  slides.joints[1].prismatic = true;
  five.joints.pop_back();
  EXPECT_NE(refused(offset).find("do not meet in a point"), std::string::npos);
  EXPECT_NE(refused(skew).find("not parallel"), std::string::npos);
  EXPECT_NE(refused(slides).find("slides"), std::string::npos);
  EXPECT_NE(refused(five).find("six joints"), std::string::npos);
}

}  // namespace
}  // namespace posewright
