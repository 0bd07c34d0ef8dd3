// Errors by axis against sums written out, and what the covariance predicts of poses that were not fitted against what
// many virtual calibrations show.

#include "posewright/calibration/axis_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "posewright/calibration/placing_columns.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

const AxisErrors& axis(const std::vector<AxisErrors>& all, const std::string& name) {
  for (const AxisErrors& e : all)
    if (e.axis == name) return e;
  throw std::out_of_range(name);
}

class ThreeTargets : public testing::Test {
 protected:
  ThreeTargets() {
    poses_ = random_poses(*model_, 5, random_);
    for (MeasuredPose& pose : poses_) {
      EXPECT_TRUE(model_->predict(pose.q, {}, predicted_.emplace_back()));
      pose.y = predicted_.back();
    }
  }
  std::vector<Eigen::VectorXd> residuals() const {
    std::vector<Eigen::VectorXd> all;
    for (std::size_t k = 0; k < poses_.size(); ++k) all.push_back(poses_[k].y - predicted_[k]);
    return all;
  }
  Problem problem_ = example("kr270/problem.yaml");
  std::unique_ptr<IdentificationModel> model_ = make_model(problem_);
  Random random_{3, 1};
  std::vector<MeasuredPose> poses_;
  std::vector<Eigen::VectorXd> predicted_;
};

TEST_F(ThreeTargets, ThatStandOffTogetherAreOffAlongTheAxesAndNotTurned) {
  for (std::size_t k = 0; k < poses_.size(); ++k)
    for (Eigen::Index t = 0; t < 3; ++t)
      poses_[k].y.segment<3>(3 * t) += Eigen::Vector3d(1e-3, k % 2 == 0 ? 2e-3 : -2e-3, 0);
  const std::vector<AxisErrors> all = errors_by_axis(*model_, poses_, residuals());
  ASSERT_EQ(all.size(), 8U);
  EXPECT_EQ(axis(all, "x").count, 15);
  EXPECT_NEAR(axis(all, "x").mean, 1e-3, 1e-12);
  EXPECT_NEAR(axis(all, "x").deviation, 0, 1e-9);
  EXPECT_NEAR(axis(all, "y").mean, 2e-3 / 5, 1e-12);
  EXPECT_NEAR(axis(all, "y").rms, 2e-3, 1e-12);
  EXPECT_NEAR(axis(all, "y").deviation, 2e-3 * std::sqrt(1 - 0.04), 1e-12);
  EXPECT_NEAR(axis(all, "distance").mean, std::hypot(1e-3, 2e-3), 1e-12);
  EXPECT_LT(axis(all, "angle").largest, 1e-7);
}

TEST_F(ThreeTargets, ThatTurnTogetherAreTurnedByThatMuchAboutThatAxis) {
  const Eigen::Vector3d turn(0.2e-3, -0.4e-3, 1e-3);
  for (MeasuredPose& pose : poses_) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (Eigen::Index t = 0; t < 3; ++t) centre += pose.y.segment<3>(3 * t) / 3;
    for (Eigen::Index t = 0; t < 3; ++t)
      pose.y.segment<3>(3 * t) = centre + rotation_by(turn) * (pose.y.segment<3>(3 * t) - centre);
  }
  const std::vector<AxisErrors> all = errors_by_axis(*model_, poses_, residuals());
  EXPECT_NEAR(axis(all, "rx").mean, turn.x(), 1e-9);
  EXPECT_NEAR(axis(all, "ry").mean, turn.y(), 1e-9);
  EXPECT_NEAR(axis(all, "rz").mean, turn.z(), 1e-9);
  EXPECT_NEAR(axis(all, "angle").rms, turn.norm(), 1e-9);
}

TEST_F(ThreeTargets, OfWhichOneIsNotReadSayNothingOfTheTurn) {
  for (MeasuredPose& pose : poses_) pose.y[4] = std::nan("");
  const std::vector<AxisErrors> all = errors_by_axis(*model_, poses_, residuals());
  EXPECT_EQ(all.size(), 4U);
  EXPECT_EQ(axis(all, "x").count, 15);
  EXPECT_EQ(axis(all, "y").count, 10);
  EXPECT_EQ(axis(all, "distance").count, 10);
}

/// Of one example: mean square of what is observed over what was predicted with noise, over many calibrations.
void expect_predicted_as_observed(const std::string& file, int poses) {
  const Problem problem = example(file);
  const auto model = make_model(problem);
  VariantColumns columns = select_columns(*model, {problem, find_variant(problem, "")});
  Random random(11, 2);
  std::vector<MeasuredPose> fitted = random_poses(*model, poses, random), others = random_poses(*model, 20, random);
  read_poses_of(*model, std::vector<double>(model->parameters().size()), 0.0, random, fitted);
  columns = determined(*model, columns, fitted, {}, Prior::none);
  double position[3] = {0, 0, 0}, rotation[3] = {0, 0, 0};
  for (int draw = 0; draw < 60; ++draw) {
    const std::vector<double> truth = random_truth(*model, columns, 0.05, random);
    read_poses_of(*model, truth, 1.0, random, fitted);
    read_poses_of(*model, truth, 1.0, random, others);
    const Fit result = fit(*model, columns, fitted, {});
    const auto predicted = predicted_errors(*model, columns, others, result);
    const auto observed = observed_errors(*model, residuals_of(*model, result.correction, others));
    for (std::size_t k = 0; k < others.size(); ++k) {
      const auto add = [&](double* sums, double PoseError::*kind) {
        sums[0] += std::pow(predicted[k].by_estimate.*kind, 2);
        sums[1] += std::pow(predicted[k].with_noise.*kind, 2);
        sums[2] += std::pow(observed[k].*kind, 2);
      };
      add(position, &PoseError::position);
      add(rotation, &PoseError::rotation);
    }
  }
  // 20 poses of 60 draws share their estimates: some per cent of chance.
  EXPECT_NEAR(position[2] / position[1], 1, 0.08) << file;
  EXPECT_GT(position[0], 0.1 * position[1]) << file;
  if (std::isfinite(rotation[1])) {
    EXPECT_NEAR(rotation[2] / rotation[1], 1, 0.08) << file;
  }
}

TEST(PredictedErrors, AreWhatManyCalibrationsShowAtPosesThatWereNotFitted) {
  expect_predicted_as_observed("kr270/problem.yaml", 18);
  expect_predicted_as_observed("instruments/photogrammetry.yaml", 18);
}

}  // namespace
}  // namespace posewright
