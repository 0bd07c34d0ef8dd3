// The tip's errors against displacements put in by hand, and what noise alone makes of the largest against runs of
// noise alone.

#include "posewright/calibration/tip_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "posewright/model/model_factory.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

const LargestTipError& axis(const std::vector<LargestTipError>& all, const std::string& name) {
  for (const LargestTipError& e : all)
    if (e.axis == name) return e;
  throw std::out_of_range(name);
}

class TipErrors : public testing::Test {
 protected:
  TipErrors() { fit_.scale_known = true; }
  std::vector<LargestTipError> errors(const std::vector<Eigen::VectorXd>& residuals) const {
    return tip_errors(*model_, poses_, fit_, std::vector<double>(model_->parameters().size(), 0.0), residuals);
  }
  std::vector<Eigen::VectorXd> residuals() const {
    return residuals_of(*model_, std::vector<double>(model_->parameters().size(), 0.0), poses_);
  }
  std::unique_ptr<IdentificationModel> model_ = make_model(example("kr270/problem.yaml"));
  Random random_{3, 1};
  std::vector<MeasuredPose> poses_ = random_poses(*model_, 8, random_);
  Fit fit_;
};

TEST_F(TipErrors, AreTheDisplacementAndTheRotationAboutTheTipOfAllTargetsTogether) {
  const Eigen::Vector3d shift(1e-3, -2e-3, 0.5e-3), turn(0.2e-3, -0.4e-3, 0.3e-3);
  for (MeasuredPose& pose : poses_) {
    ASSERT_TRUE(model_->predict(pose.q, {}, pose.y));
    const Eigen::Vector3d tip = model_->tool_pose(pose.q).translation();
    for (Eigen::Index t = 0; t < 3; ++t) {
      const Eigen::Vector3d p = pose.y.segment<3>(3 * t);
      pose.y.segment<3>(3 * t) = tip + rotation_by(turn) * (p - tip) + shift;
    }
  }
  const std::vector<LargestTipError> all = errors(residuals());
  ASSERT_EQ(all.size(), 6U);
  EXPECT_EQ(axis(all, "x").count, 8);
  // To the first order of the rotation.
  EXPECT_NEAR(axis(all, "x").largest, 1e-3, 1e-6);
  EXPECT_NEAR(axis(all, "y").largest, 2e-3, 1e-6);
  EXPECT_NEAR(axis(all, "z").largest, 0.5e-3, 1e-6);
  EXPECT_NEAR(axis(all, "rx").largest, 0.2e-3, 1e-6);
  EXPECT_NEAR(axis(all, "ry").largest, 0.4e-3, 1e-6);
  EXPECT_NEAR(axis(all, "rz").largest, 0.3e-3, 1e-6);
}

TEST_F(TipErrors, OfNoiseAloneAreLargerThanStatedInFiveOfHundredRuns) {
  const std::vector<double> nothing(model_->parameters().size(), 0.0);
  std::vector<int> above(6, 0);
  const int runs = 600;
  for (int run = 0; run < runs; ++run) {
    read_poses_of(*model_, nothing, 1.0, random_, poses_);
    const std::vector<LargestTipError> all = errors(residuals());
    ASSERT_EQ(all.size(), 6U);
    for (std::size_t a = 0; a < 6; ++a) above[a] += int(all[a].largest > all[a].by_noise);
  }
  // 30 expected; four standard deviations of the count are 21.
  for (const int count : above) EXPECT_NEAR(count, 30, 21);
}

TEST_F(TipErrors, OfOneTargetAreThoseOfItsReadings) {
  read_poses_of(*model_, std::vector<double>(model_->parameters().size(), 0.0), 0.0, random_, poses_);
  for (MeasuredPose& pose : poses_) {
    pose.y[0] += 1e-3;
    pose.y.tail(6).setConstant(std::nan(""));
  }
  const std::vector<LargestTipError> all = errors(residuals());
  ASSERT_EQ(all.size(), 3U);
  EXPECT_NEAR(axis(all, "x").largest, 1e-3, 1e-9);
  EXPECT_NEAR(axis(all, "y").largest, 0, 1e-9);
}

}  // namespace
}  // namespace posewright
