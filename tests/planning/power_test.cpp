#include "posewright/planning/power.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "posewright/support/random.hpp"

namespace posewright {
namespace {

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

TEST(Power, WithOneDegreeOfFreedomItIsThatOfTheTwoSidedNormalTest) {
  const double z = 1.959963984540054;
  for (const double lambda : {0.01, 1.0, 4.0, 10.507, 30.0}) {
    const double shift = std::sqrt(lambda);
    EXPECT_NEAR(chi_square_power(lambda, 1, 0.05), normal_cdf(shift - z) + normal_cdf(-shift - z), 1e-10);
  }
}

TEST(Power, WithoutEffectItIsTheLevelAndItGrowsWithTheEffect) {
  for (const double df : {1.0, 7.0, 100.0, 3000.0}) {
    double before = 0.05;
    EXPECT_NEAR(chi_square_power(0, df, 0.05), 0.05, 1e-12);
    for (const double lambda : {0.5, 2.0, 20.0, 200.0, 2e4, 1e7, 1e12}) {
      const double power = chi_square_power(lambda, df, 0.05);
      EXPECT_GE(power, before) << df << " " << lambda;
      EXPECT_LE(power, 1);
      before = power;
    }
    EXPECT_NEAR(before, 1, 1e-12);
  }
}

TEST(Power, MoreDegreesOfFreedomForTheSameEffectTellLess) {
  EXPECT_GT(chi_square_power(10, 1, 0.05), chi_square_power(10, 5, 0.05));
  EXPECT_GT(chi_square_power(10, 5, 0.05), chi_square_power(10, 500, 0.05));
}

TEST(Power, AgreesWithSimulatedResiduals) {
  constexpr int df = 12, trials = 40000;
  constexpr double lambda = 9.0, threshold = 21.026069817483;  // 95 % quantile for 12
  Random random(1, 0);
  int rejected = 0;
  for (int trial = 0; trial < trials; ++trial) {
    double sum = 0;
    for (int i = 0; i < df; ++i) {
      const double noise =
          std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * std::numbers::pi * random.uniform());
      sum += std::pow(noise + std::sqrt(lambda / df), 2);
    }
    rejected += sum > threshold ? 1 : 0;
  }
  const double power = chi_square_power(lambda, df, 0.05);
  EXPECT_NEAR(double(rejected) / trials, power, 4 * std::sqrt(power * (1 - power) / trials));
}

TEST(Power, RepetitionsAreTheFewestThatReachIt) {
  constexpr int readings = 30, fitted = 20;
  for (const double lambda : {0.1, 0.5, 3.0, 50.0}) {
    const auto k = repetitions_for_power(lambda, readings, fitted, 0.05, 0.9);
    ASSERT_TRUE(k);
    EXPECT_GE(chi_square_power(*k * lambda, *k * readings - fitted, 0.05), 0.9);
    if (*k > 1) {
      EXPECT_LT(chi_square_power((*k - 1) * lambda, (*k - 1) * readings - fitted, 0.05), 0.9);
    }
  }
  // (z₀.₉₇₅ + z₀.₉)² = 10.507 along the effect.
  EXPECT_EQ(repetitions_along_effect(1.0, 0.05, 0.9), 11);
  EXPECT_EQ(repetitions_along_effect(10.6, 0.05, 0.9), 1);
  EXPECT_FALSE(repetitions_for_power(0, readings, fitted, 0.05, 0.9));
  EXPECT_FALSE(repetitions_for_power(1e-9, readings, fitted, 0.05, 0.9));
}

TEST(Power, NumbersOutOfRangeAreRefused) {
  EXPECT_THROW(chi_square_power(-1, 3, 0.05), std::invalid_argument);
  EXPECT_THROW(chi_square_power(1, 0, 0.05), std::invalid_argument);
  EXPECT_THROW(chi_square_power(1, 3, 1), std::invalid_argument);
}

}  // namespace
}  // namespace posewright
