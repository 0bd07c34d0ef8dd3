// A platform that is deformed by hand, as the published study measured it, photographed with noise.

#include "posewright/calibration/platform_deformation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "posewright/model/rotation_vector.hpp"
#include "posewright/support/distributions.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

/// Telescope study, eq. (10), in thousandths.
Eigen::Matrix<double, 6, 6> published_K() {
  Eigen::Matrix<double, 6, 6> K;
  K << 16, 0, -8, 12, -2, -20, 0, 20, -17, -1, 13, -13, -2, -15, 14, 2, -9, 9, 6, -12, 4, 14, -16, 2, -12, 7, 0, -15,
      14, 4, -20, -1, 10, -10, 2, 19;
  return 1e-3 * K;
}

class Platform {
 public:
  Platform(int points, double noise, const Eigen::Matrix<double, 6, 6>& K, int images = 40) {
    for (int k = 0; k < points; ++k) {
      const double angle = 2 * std::numbers::pi * k / points;
      nominal.emplace_back(0.12 * std::cos(angle), 0.12 * std::sin(angle), 0.01 * (k % 2));
    }
    // Nobody measured the points: they are some tenths of a millimetre from where they are drawn.
    std::vector<Eigen::Vector3d> real = nominal;
    for (Eigen::Vector3d& p : real) p += normal(3e-4);
    for (int i = 0; i < images; ++i) {
      PlatformImage image;
      image.id = i + 1;
      image.actuators.resize(6);
      for (double& rho : image.actuators) rho = random.uniform(-1.3e-3, 1.3e-3);
      const Eigen::Isometry3d X = Eigen::Translation3d(Eigen::Vector3d(0, 0, 0.48) + normal(1e-3)) *
                                  Eigen::Isometry3d(rotation_by(normal(5e-3)));
      for (const Eigen::Vector3d& p : real) image.body.push_back(X * p + normal(noise));
      const Eigen::VectorXd lift = K * image.actuators;
      for (int leg = 0; leg < 6; ++leg) {
        const double angle = leg * std::numbers::pi / 3;
        const Eigen::Vector3d b(0.18 * std::cos(angle), 0.18 * std::sin(angle), lift[leg]);
        image.joints.push_back(X * b + normal(noise));
      }
      images_.push_back(std::move(image));
    }
  }
  PlatformDeformation judge(double noise) const { return platform_deformation(nominal, images_, noise); }
  std::vector<PlatformImage>& images() { return images_; }
  std::vector<Eigen::Vector3d> nominal;

 private:
  Eigen::Vector3d normal(double size) {
    return size * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  }
  Random random{21, 3};
  std::vector<PlatformImage> images_;
};

TEST(PlatformDeformation, WithoutNoiseIsTheMatrixThatMovedTheJoints) {
  const Eigen::Matrix<double, 6, 6> K = published_K();
  const PlatformDeformation found = Platform(5, 0.0, K).judge(3e-6);
  EXPECT_LT(found.rms, 1e-12);
  for (Eigen::Index leg = 0; leg < 6; ++leg) {
    const JointDeformation& joint = found.joints[std::size_t(leg)];
    // Frames differ by some tenths of a millimetre over 0.12 m, which turns z by milliradians.
    EXPECT_LT((joint.K - K.row(leg)).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT(joint.left_by_K, 1e-9);
    EXPECT_GT(joint.largest, 10e-6);
    EXPECT_LT(joint.largest, 120e-6);
    EXPECT_LT(joint.spread.head<2>().maxCoeff(), 1e-6);
  }
}

TEST(PlatformDeformation, OfOneCoefficientALegIsFoundWithinItsSigma) {
  const Eigen::Matrix<double, 6, 6> K = 0.011 * Eigen::Matrix<double, 6, 6>::Identity();
  int far = 0;
  const PlatformDeformation found = Platform(5, 3e-6, K, 80).judge(3e-6);
  for (const JointDeformation& joint : found.joints) {
    EXPECT_NEAR(joint.kappa, 0.011, 4 * joint.kappa_sigma);
    EXPECT_LT(joint.kappa_sigma, 0.001);
    EXPECT_NEAR(joint.left_by_kappa, joint.left_by_K, 1e-6);
    for (Eigen::Index j = 0; j < 6; ++j)
      far += std::abs(joint.K[j] - (&joint - found.joints.data() == j ? 0.011 : 0)) > 2 * joint.K_sigma[j] ? 1 : 0;
  }
  EXPECT_LE(far, 6);  // of 36, 5 % are to be expected
}

TEST(PlatformDeformation, SaysWhetherTheBodyItselfIsRigid) {
  Platform rigid(5, 3e-6, published_K());
  const PlatformDeformation right = rigid.judge(3e-6);
  EXPECT_EQ(right.freedom, 15 * 40 - 240 - 9);
  EXPECT_GT(chi_square_exceeded(right.chi_square, right.freedom), 1e-3);
  EXPECT_LT(chi_square_exceeded(right.chi_square, right.freedom), 0.999);
  // One of its points belongs to the ring that gives way.
  for (PlatformImage& image : rigid.images()) image.body[2].z() += 0.02 * image.actuators[1];
  const PlatformDeformation wrong = rigid.judge(3e-6);
  EXPECT_LT(chi_square_exceeded(wrong.chi_square, wrong.freedom), 1e-6);
}

TEST(PlatformDeformation, NeedsThreePointsAndMoreImagesThanUnknowns) {
  EXPECT_THROW(Platform(5, 0.0, published_K(), 7).judge(3e-6), CannotDo);
  EXPECT_THROW(Platform(2, 0.0, published_K()).judge(3e-6), CannotDo);
}

}  // namespace
}  // namespace posewright
