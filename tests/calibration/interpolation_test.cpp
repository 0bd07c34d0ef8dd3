// Prediction with what the parameters leave. The second road fits again without each pose and inverts the covariance of
// all readings, written down from the kernel's definition.

#include "posewright/calibration/interpolation.hpp"

#include <gtest/gtest.h>

#include "tests/kit/drawn_positioner.hpp"

namespace posewright {
namespace {

constexpr double size = 0.5e-3;

class Interpolations : public DrawnPositioner {
 protected:
  Interpolations() : effect_(std::make_shared<UnmodelledEffect>(*model_, UnmodelledSize{size, 0.0, pi / 3})) {}

  Interpolation interpolated(const std::vector<MeasuredPose>& poses,
                             const std::vector<MeasuredPose>& others = {}) const {
    return interpolate(*model_, columns_, poses, others, fitted(poses, effect_), effect_);
  }

  /// Readings of `at` less what the parameters of `result` and the effect left at `poses` say of it.
  Eigen::VectorXd missed(const std::vector<MeasuredPose>& poses, const MeasuredPose& at, const Fit& result) const {
    const auto n = Eigen::Index(poses.size());
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(6 * n, 6 * n), cross = Eigen::MatrixXd::Zero(6, 6 * n);
    Eigen::VectorXd r(6 * n);
    Linearisation out;
    for (Eigen::Index i = 0; i < n; ++i) {
      const MeasuredPose& pose = poses[std::size_t(i)];
      model_->linearise(pose.q, result.correction, {}, out);
      S.block<6, 6>(6 * i, 6 * i) += out.covariance;
      for (Eigen::Index k = 0; k < n; ++k)
        S.block<3, 3>(6 * i, 6 * k).diagonal().array() +=
            size * size * correlation(pose.q, poses[std::size_t(k)].q, pi / 3);
      cross.block<3, 3>(0, 6 * i).diagonal().array() += size * size * correlation(at.q, pose.q, pi / 3);
      r.segment<6>(6 * i) = residuals_of(*model_, result.correction, {pose}).front();
    }
    return residuals_of(*model_, result.correction, {at}).front() - cross * S.inverse() * r;
  }

  std::shared_ptr<const UnmodelledEffect> effect_;
};

TEST_F(Interpolations, PosesLeftOutAreMissedAsByFitsWithoutThem) {
  const auto poses = drawn(14, size, pi / 3, 1.0, 4);
  double alone = 0, with = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    auto rest = poses;
    rest.erase(rest.begin() + std::ptrdiff_t(k));
    const Fit without = fitted(rest, effect_);
    alone += residuals_of(*model_, without.correction, {poses[k]}).front().head<3>().squaredNorm();
    with += missed(rest, poses[k], without).head<3>().squaredNorm();
  }
  const Interpolation found = interpolated(poses);
  ASSERT_EQ(found.why_not, "");
  EXPECT_EQ(found.unit, "m");
  EXPECT_NEAR(found.alone / std::sqrt(alone / 42), 1, 2e-3);
  EXPECT_NEAR(found.interpolated / std::sqrt(with / 42), 1, 2e-3);
}

TEST_F(Interpolations, OtherPosesAreMissedAsByTheWholeCovariance) {
  const auto poses = drawn(40, size, pi / 3, 1.0, 8);
  const std::vector<MeasuredPose> fitted_ones(poses.begin(), poses.begin() + 30),
      others(poses.begin() + 30, poses.end());
  const Interpolation found = interpolated(fitted_ones, others);
  const Fit result = fitted(fitted_ones, effect_);
  ASSERT_EQ(found.others.size(), others.size());
  for (std::size_t k = 0; k < others.size(); ++k) {
    const Eigen::VectorXd expected = missed(fitted_ones, others[k], result);
    for (Eigen::Index i = 0; i < 6; ++i) EXPECT_NEAR(found.others[k][i], expected[i], 1e-9);
  }
}

TEST_F(Interpolations, GainWhereThereIsAnEffectAndSeldomWhereThereIsNone) {
  int gained = 0, gained_by_chance = 0;
  for (std::uint64_t i = 0; i < 20; ++i) {
    gained += interpolated(drawn(40, size, pi / 3, 1.0, 40 + i)).gains() ? 1 : 0;
    gained_by_chance += interpolated(drawn(40, 0.0, pi / 3, 1.0, 80 + i)).gains() ? 1 : 0;
  }
  EXPECT_GE(gained, 18);
  EXPECT_LE(gained_by_chance, 1);
}

}  // namespace
}  // namespace posewright
