// Constants of a gravity compensator from listed compliances: published figures, and chance drawn here.

#include "posewright/calibration/compensator_constants.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr double degree = std::numbers::pi / 180;

CompensatorSpec published_linkage() {
  CompensatorSpec linkage;
  linkage.L = 184.72e-3;
  linkage.ax = 685.93e-3;
  linkage.ay = 123.30e-3;
  return linkage;
}

/// Klimchik et al. 2013, Table VI: compliances of the second joint and half their 95 % intervals in per cent.
ListedCompliances published(const std::vector<double>& k2, const std::vector<double>& per_cent) {
  ListedCompliances listed;
  listed.at = {-0.01 * degree, -25.2 * degree, -56.9 * degree, -99.8 * degree, -140 * degree};
  listed.compliance = 1e-6 * Eigen::Map<const Eigen::VectorXd>(k2.data(), 5);
  const Eigen::VectorXd sigma =
      listed.compliance.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(per_cent.data(), 5)) / 196;
  listed.covariance = sigma.cwiseAbs2().asDiagonal();
  return listed;
}

/// Stiffness of the joint with the spring by the geometry alone: the spring's torque is the gradient of its energy
/// ½ Kc (s − s0)², s the distance of the pins.
double stiffness_by_energy(const CompensatorSpec& linkage, double q2, double joint, double spring, double free_length) {
  const auto energy = [&](double q) {
    const double a = std::hypot(linkage.ax, linkage.ay), gamma = std::atan2(linkage.ax, linkage.ay) - q;
    const double s = std::sqrt(a * a + linkage.L * linkage.L + 2 * a * linkage.L * std::cos(gamma));
    return 0.5 * spring * (s - free_length) * (s - free_length);
  };
  constexpr double h = 1e-3;
  return joint + (energy(q2 + h) - 2 * energy(q2) + energy(q2 - h)) / (h * h);
}

TEST(CompensatorConstants, FromThePublishedCompliancesWithEqualWeightsAreNearThePublishedOnes) {
  const std::vector<double> k2 = {.297, .287, .315, .302, .251};
  // Equal σ of the stiffness 1/k: that of k goes with k².
  std::vector<double> equal;
  for (const double k : k2) equal.push_back(10 * k);
  const CompensatorConstants found = compensator_from_compliances(published_linkage(), published(k2, equal));
  EXPECT_NEAR(1e6 / found.joint_stiffness, 0.305, 5e-4);
  EXPECT_NEAR(1e6 / found.stiffness, 0.137, 5e-4);
  EXPECT_NEAR(1e3 * found.free_length, 464, 0.5);
  EXPECT_EQ(found.freedom, 2);
}

TEST(CompensatorConstants, DoNotFitTheFivePublishedCompliancesWithinTheirOwnIntervals) {
  const CompensatorConstants ordinary = compensator_from_compliances(
      published_linkage(), published({.297, .287, .315, .302, .251}, {3.4, 4.2, 5.9, 10.7, 7.8}));
  EXPECT_NEAR(1e6 / ordinary.joint_stiffness, 0.301, 1e-3);
  // 5 % of right ones leave more than 6 with two degrees of freedom.
  EXPECT_GT(ordinary.chi_square, 15);
  const CompensatorConstants weighted = compensator_from_compliances(
      published_linkage(), published({.287, .277, .302, .293, .246}, {.09, .13, .18, .33, .27}));
  EXPECT_GT(weighted.chi_square, 1000);
}

TEST(CompensatorConstants, OfExactCompliancesAreTheOnesThatTheyWereMadeOf) {
  const CompensatorSpec linkage = published_linkage();
  ListedCompliances listed = published({1, 1, 1, 1, 1}, {1, 2, 3, 2, 1});
  for (Eigen::Index i = 0; i < 5; ++i)
    listed.compliance[i] = 1 / stiffness_by_energy(linkage, listed.at[std::size_t(i)], 3.3e6, 7e6, 0.458);
  const CompensatorConstants found = compensator_from_compliances(linkage, listed);
  EXPECT_NEAR(found.joint_stiffness / 3.3e6, 1, 1e-4);
  EXPECT_NEAR(found.stiffness / 7e6, 1, 1e-4);
  EXPECT_NEAR(found.free_length / 0.458, 1, 1e-4);
}

TEST(CompensatorConstants, ScatterAsTheirCovarianceSays) {
  const CompensatorSpec linkage = published_linkage();
  ListedCompliances exact = published({1, 1, 1, 1, 1}, {1, 1, 1, 1, 1});
  for (Eigen::Index i = 0; i < 5; ++i)
    exact.compliance[i] = 1 / stiffness_by_energy(linkage, exact.at[std::size_t(i)], 3.3e6, 7e6, 0.458);
  // Two compliances that err together, so that the whole covariance counts.
  Eigen::MatrixXd root = (5e-4 * exact.compliance).asDiagonal();
  root(1, 0) = 0.8 * root(1, 1);
  exact.covariance = root * root.transpose();
  const CompensatorConstants at = compensator_from_compliances(linkage, exact);
  Random random(8, 4);
  Eigen::Vector4d squares = Eigen::Vector4d::Zero();
  constexpr int draws = 2000;
  double chi_square = 0;
  for (int i = 0; i < draws; ++i) {
    ListedCompliances drawn = exact;
    Eigen::VectorXd z(5);
    for (double& value : z) value = random.normal();
    drawn.compliance += root * z;
    const CompensatorConstants c = compensator_from_compliances(linkage, drawn);
    squares += Eigen::Vector4d(c.joint_stiffness - at.joint_stiffness, c.stiffness - at.stiffness,
                               c.preload - at.preload, c.free_length - at.free_length)
                   .cwiseAbs2() /
               draws;
    chi_square += c.chi_square / draws;
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::sqrt(squares[k] / at.covariance(k, k)), 1, 0.06) << k;
  EXPECT_NEAR(std::sqrt(squares[3]) / at.free_length_sigma, 1, 0.08);
  EXPECT_NEAR(chi_square, 2, 0.2);
}

TEST(CompensatorConstants, AreRefusedWhereTheListSaysTooLittle) {
  ListedCompliances listed = published({.297, .287, .315, .302, .251}, {1, 1, 1, 1, 1});
  listed.compliance[2] = -1e-7;
  EXPECT_THROW(compensator_from_compliances(published_linkage(), listed), CannotDo);
  listed = published({.297, .287, .315, .302, .251}, {1, 1, 1, 1, 1});
  listed.covariance.setZero();
  EXPECT_THROW(compensator_from_compliances(published_linkage(), listed), CannotDo);
  listed.at.resize(2);
  EXPECT_THROW(compensator_from_compliances(published_linkage(), listed), CannotDo);
}

}  // namespace
}  // namespace posewright
