// Criteria that plan against effects of a truth: known answers, derivatives.

#include "posewright/criterion/effect_criteria.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "posewright/criterion/registry.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "posewright/criterion/trace.hpp"
#include "tests/kit/plackett_burman.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

constexpr int fitted_columns = 4, more_columns = 3, all_columns = fitted_columns + more_columns;

Eigen::MatrixXd random_matrix(int rows, int columns, std::uint64_t seed) {
  return random_blocks(1, rows, columns, seed).block(0);
}

Eigen::MatrixXd random_information(std::uint64_t seed) {
  const Eigen::MatrixXd X = random_matrix(20, all_columns, seed);
  return X.transpose() * X;
}

Eigen::MatrixXd symmetric_direction(std::uint64_t seed) {
  const Eigen::MatrixXd D = random_matrix(all_columns, all_columns, seed);
  return D + D.transpose();
}

void expect_gradient_of(const InformationFunction& function) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const Eigen::MatrixXd M = random_information(seed), D = symmetric_direction(seed + 50);
    constexpr double h = 1e-5;
    const double numeric = (function.value(M + h * D) - function.value(M - h * D)) / (2 * h);
    EXPECT_NEAR(function.gradient(M).cwiseProduct(D).sum(), numeric, 1e-8 * (1 + std::abs(numeric))) << seed;
  }
}

TEST(Discriminate, DerivativeAgreesWithDifferences) {
  expect_gradient_of(DiscriminateFunction(fitted_columns, random_matrix(more_columns, 5, 3)));
  expect_gradient_of(DiscriminateFunction(fitted_columns, random_matrix(more_columns, 1, 4)));
}

TEST(Bias, DerivativeAgreesWithDifferences) {
  for (const int rows : {2, 40})
    expect_gradient_of(BiasFunction(random_matrix(rows, fitted_columns, 3), random_matrix(more_columns, 5, 4),
                                    random_matrix(rows, 5, 6)));
}

TEST(Discriminate, CurvatureAgreesWithDifferencesOfTheDerivative) {
  const DiscriminateFunction function(fitted_columns, random_matrix(more_columns, 2, 3));
  const Eigen::MatrixXd M = random_information(2);
  const auto expansion = function.expand(M);
  ASSERT_NE(expansion, nullptr);
  EXPECT_DOUBLE_EQ(expansion->value, function.value(M));
  EXPECT_TRUE(expansion->factor.isUpperTriangular());
  EXPECT_LT((expansion->factor * expansion->factor.transpose() - function.gradient(M)).norm(), 1e-12);
  for (const int r : {1, 3}) {
    const BlockArray blocks = random_blocks(5, r, all_columns, 9);
    Eigen::MatrixXd H;
    expansion->curvature(blocks.all(), r, H);
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = 0; j < 5; ++j) {
        const Eigen::MatrixXd X = blocks.block(i).transpose() * blocks.block(i),
                              Y = blocks.block(j).transpose() * blocks.block(j);
        constexpr double h = 1e-5;
        const Eigen::MatrixXd change = (function.gradient(M + h * Y) - function.gradient(M - h * Y)) / (2 * h);
        EXPECT_NEAR(H(Eigen::Index(i), Eigen::Index(j)), -change.cwiseProduct(X).sum(), 1e-7);
      }
  }
}

TEST(Discriminate, IsConcaveAndOfDegreeOne) {
  const DiscriminateFunction function(fitted_columns, random_matrix(more_columns, 2, 3));
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const Eigen::MatrixXd M = random_information(seed), N = random_information(seed + 100);
    EXPECT_GE(std::exp(function.value(0.3 * M + 0.7 * N)),
              0.3 * std::exp(function.value(M)) + 0.7 * std::exp(function.value(N)) - 1e-9);
    EXPECT_NEAR(function.value(5 * M), function.value(M) + std::log(5.0), 1e-12);
    EXPECT_NEAR(function.gradient(M).cwiseProduct(M).sum(), 1, 1e-12);
  }
}

TEST(Discriminate, WithoutAReadingToSpareThereIsNothingToTellBy) {
  const DiscriminateFunction function(fitted_columns, random_matrix(more_columns, 2, 3));
  for (const int rows : {fitted_columns - 1, fitted_columns}) {
    const Eigen::MatrixXd X = random_matrix(rows, all_columns, 8);
    EXPECT_EQ(function.value(X.transpose() * X), -std::numeric_limits<double>::infinity()) << rows;
  }
  const Eigen::MatrixXd X = random_matrix(fitted_columns + 1, all_columns, 8);
  EXPECT_TRUE(std::isfinite(function.value(X.transpose() * X)));
}

TEST(Bias, WithoutEffectsItIsTestPose) {
  CriterionData data{Eigen::MatrixXd::Identity(fitted_columns, fitted_columns), Eigen::VectorXd::Ones(fitted_columns),
                     0};
  for (int t = 0; t < 3; ++t)
    data.test_points.push_back({random_matrix(3, fitted_columns, 60 + std::uint64_t(t)), 1.0 + t});
  const Eigen::MatrixXd rows = test_point_rows(data);
  const BiasFunction bias(rows, Eigen::MatrixXd::Zero(more_columns, 2), Eigen::MatrixXd::Zero(rows.rows(), 2));
  const TraceFunction test_pose(rows);
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    const Eigen::MatrixXd M = random_information(seed);
    EXPECT_NEAR(bias.value(M), test_pose.value(M.topLeftCorner(fitted_columns, fitted_columns)), 1e-12);
  }
}

/// Seven fitted columns, of which the constant is nuisance, fifteen interactions of size one each.
CriterionData screening() {
  constexpr int all = plackett_burman_columns, own = plackett_burman_main;
  CriterionData data{Eigen::MatrixXd::Identity(all, all), Eigen::VectorXd::Ones(all), 1};
  Eigen::MatrixXd interest = Eigen::MatrixXd::Zero(own - 1, own);
  interest.rightCols(own - 1).setIdentity();
  data.effects = {all - own, Eigen::MatrixXd::Identity(all - own, all - own), interest,
                  Eigen::MatrixXd::Zero(own - 1, all - own)};
  return data;
}

TEST(Bias, PlackettBurmanHasSixTwelfthsOfVarianceAndTwentyThirdsOfBias) {
  const BlockArray X = plackett_burman();
  const Eigen::MatrixXd M = X.all().transpose() * X.all();
  EXPECT_NEAR(make_criterion("bias", screening())->function().value(M), -std::log(6.0 / 12 + 20.0 / 3), 1e-12);
}

TEST(Bias, OfManyCandidatesNoneGainsWhereTheStateSeesNone) {
  // More candidates than a swap is looked for among at first.
  const BlockArray blocks = random_blocks(200, 2, all_columns, 31);
  CriterionData data{Eigen::MatrixXd::Identity(all_columns, all_columns), Eigen::VectorXd::Ones(all_columns), 0};
  data.effects = {more_columns, 3 * random_matrix(more_columns, 5, 4), random_matrix(6, fitted_columns, 3),
                  random_matrix(6, 5, 6)};
  const auto criterion = make_criterion("bias", data);
  const auto state = criterion->start({&blocks, 0, 1}, {0, 1, 2, 3, 4, 5});
  const auto value_of = [&](const std::vector<int>& members) {
    return criterion->function().value(summed_information(blocks, nullptr, members));
  };
  int swaps = 0;
  for (int quiet = 0, position = 0; quiet < 6; position = (position + 1) % 6, ++quiet) {
    const Swap swap = state->best_swap(position, 1e-9);
    if (swap.enter < 0) continue;
    const double before = state->value();
    state->apply(position, swap.enter);
    EXPECT_NEAR(state->value(), before + swap.gain, 1e-9);
    quiet = -1;
    ASSERT_LT(++swaps, 200);
  }
  EXPECT_GT(swaps, 3);
  EXPECT_NEAR(value_of(state->members()), state->value(), 1e-9);
  for (std::size_t position = 0; position < 6; ++position)
    for (int j = 0; j < 200; ++j) {
      std::vector<int> other = state->members();
      other[position] = j;
      if (!state->may_enter(j)) continue;
      EXPECT_LE(value_of(other), state->value() + 2e-9) << position << " " << j;
    }
}

TEST(Discriminate, PlackettBurmanLeavesTwelveTimesFifteenLessTwentyThirds) {
  // Each interaction has length √12; what the seven columns take up of all is 12 · 20/3.
  const BlockArray X = plackett_burman();
  const Eigen::MatrixXd M = X.all().transpose() * X.all();
  EXPECT_NEAR(make_criterion("discriminate", screening())->function().value(M), std::log(12 * (15 - 20.0 / 3)), 1e-12);
}

}  // namespace
}  // namespace posewright
