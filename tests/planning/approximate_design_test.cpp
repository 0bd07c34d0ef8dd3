#include "posewright/planning/approximate_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/effect_criteria.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/criterion/trace.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

BlockArray quadratic(int n) {
  BlockArray blocks(std::size_t(n), 1, 3);
  for (int i = 0; i < n; ++i) {
    const double x = -1 + 2.0 * i / (n - 1);
    blocks.row(std::size_t(i), 0)[0] = 1;
    blocks.row(std::size_t(i), 0)[1] = x;
    blocks.row(std::size_t(i), 0)[2] = x * x;
  }
  return blocks;
}

double weight_of(const ApproximateDesign& design, int candidate) {
  for (std::size_t i = 0; i < design.support.size(); ++i)
    if (design.support[i] == candidate) return design.weights[i];
  return 0;
}

TEST(ApproximateDesign, QuadraticOnAnIntervalPutsAThirdOnEachOfThreePoints) {
  BlockArray blocks = quadratic(101);
  whiten(blocks);
  const ApproximateDesign design = solve_approximate_design(blocks, LogDetFunction(0, blocks.columns()), {}, Monitor{});
  EXPECT_LE(design.max_sensitivity_ratio, 1 + 1e-9);
  for (const int i : {0, 50, 100}) EXPECT_NEAR(weight_of(design, i), 1.0 / 3, 1e-6);
}

TEST(ApproximateDesign, SensitivitiesAverageToTheNumberOfParameters) {
  BlockArray blocks = random_blocks(500, 3, 12, 1);
  whiten(blocks);
  const ApproximateDesign design = solve_approximate_design(blocks, LogDetFunction(0, blocks.columns()), {}, Monitor{});
  double mean = 0;
  for (std::size_t i = 0; i < design.support.size(); ++i)
    mean += design.weights[i] * design.sensitivity[std::size_t(design.support[i])];
  EXPECT_NEAR(mean, 12, 1e-9);
  EXPECT_NEAR(std::accumulate(design.weights.begin(), design.weights.end(), 0.0), 1, 1e-12);
  EXPECT_LE(*std::max_element(design.sensitivity.begin(), design.sensitivity.end()), 12 * (1 + 1e-9));
}

/// η₁ = 4.5 − 1.5 eˣ − 2 e⁻ˣ beside a quadratic, on n points of [−1, 1].
BlockArray two_exponentials(int n) {
  const BlockArray first = quadratic(n);
  BlockArray blocks(std::size_t(n), 1, 4);
  for (std::size_t i = 0; i < std::size_t(n); ++i) {
    std::copy_n(first.row(i, 0), 3, blocks.row(i, 0));
    const double x = first.row(i, 0)[1];
    blocks.row(i, 0)[3] = 4.5 - 1.5 * std::exp(x) - 2 * std::exp(-x);
  }
  return blocks;
}

TEST(ApproximateDesign, TellsTwoExponentialsFromAQuadraticAsAtkinsonAndFedorovPublished) {
  // Atkinson & Fedorov (1975), Biometrika 62(1): four points, T = 1.087e-3.
  constexpr int n = 2001;
  BlockArray blocks = two_exponentials(n);
  const Eigen::MatrixXd R = whiten(blocks).R;
  const DiscriminateFunction function(3, R.bottomRightCorner(1, 1));
  const ApproximateDesign design = solve_approximate_design(blocks, function, {}, Monitor{});
  EXPECT_LE(design.max_sensitivity_ratio, 1 + 1e-6);
  EXPECT_NEAR(std::exp(design.value), 1.0867e-3, 5e-8);
  EXPECT_NEAR(std::exp(design.bound), 1.0867e-3, 5e-8);
  const double places[] = {-1, -0.669, 0.144, 0.957}, weights[] = {0.2525, 0.4277, 0.2475, 0.0723};
  for (int k = 0; k < 4; ++k) {
    // Optima between grid points share their weight among neighbours.
    double weight = 0, place = 0;
    for (std::size_t i = 0; i < design.support.size(); ++i) {
      const double x = -1 + 2.0 * design.support[i] / (n - 1);
      if (std::abs(x - places[k]) > 0.02) continue;
      weight += design.weights[i];
      place += design.weights[i] * x;
    }
    EXPECT_NEAR(weight, weights[k], 1e-4) << k;
    EXPECT_NEAR(place / weight, places[k], 1e-3) << k;
  }
}

TEST(ApproximateDesign, NoPlanTellsMoreThanTheBoundOfDiscriminate) {
  for (const int rows : {1, 3})
    for (const int poses : {6, 9})
      for (const bool known : {false, true}) {
        constexpr int columns = 7, fitted = 4;
        BlockArray blocks = random_blocks(60, rows, columns, 9);
        whiten(blocks);
        const DiscriminateFunction function(fitted, random_blocks(1, columns - fitted, 2, 5).block(0));
        ApproximateDesignOptions options;
        options.cap = 1.0 / poses;
        if (known) options.prior = 0.1 * Eigen::MatrixXd::Identity(columns, columns);
        const ApproximateDesign design = solve_approximate_design(blocks, function, options, Monitor{});
        EXPECT_LE(design.max_sensitivity_ratio, 1 + 1e-6) << rows << " " << poses << " " << known;
        Random random(8, 0);
        for (int trial = 0; trial < 500; ++trial) {
          std::vector<int> order(60);
          std::iota(order.begin(), order.end(), 0);
          Eigen::MatrixXd M = known ? Eigen::MatrixXd(poses * options.prior) : Eigen::MatrixXd::Zero(columns, columns);
          for (int i = 0; i < poses; ++i) {
            std::swap(order[std::size_t(i)], order[std::size_t(i + random.index(60 - i))]);
            const auto block = blocks.block(std::size_t(order[std::size_t(i)]));
            M += block.transpose() * block;
          }
          EXPECT_LE(function.value(M), design.bound_for(poses));
        }
      }
}

struct Case {
  int rows, columns, nuisance, poses;
};

void PrintTo(const Case& s, std::ostream* out) {
  *out << "r = " << s.rows << ", m = " << s.columns << ", nuisance " << s.nuisance << ", N = " << s.poses;
}
class Bounds : public testing::TestWithParam<Case> {};

TEST_P(Bounds, NoRandomFeasibleWeightsExceedTheBoundAndCapsHold) {
  const auto [rows, columns, nuisance, poses] = GetParam();
  BlockArray blocks = random_blocks(300, rows, columns, 17);
  whiten(blocks);
  ApproximateDesignOptions options;
  options.cap = 1.0 / poses;
  const ApproximateDesign design =
      solve_approximate_design(blocks, LogDetFunction(nuisance, columns), options, Monitor{});
  // With 299 of 300 the weights have almost no room; rounding stops the method there, at 2e-9 or, by another order of
  // one sum, 2e-7.
  EXPECT_LE(design.max_sensitivity_ratio - 1, poses == 299 ? 1e-6 : 1e-9);
  for (const double w : design.weights) {
    EXPECT_GT(w, 0);
    EXPECT_LE(w, options.cap * (1 + 1e-12));
  }
  Random random(4, 0);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<int> order(300);
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = 0; i < std::size_t(poses); ++i)
      std::swap(order[i], order[i + std::size_t(random.index(int(300 - i)))]);
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(columns, columns);
    for (int i = 0; i < poses; ++i) {
      const auto block = blocks.block(std::size_t(order[std::size_t(i)]));
      m += block.transpose() * block / poses;
    }
    const double log_det =
        m.ldlt().vectorD().array().log().sum() -
        (nuisance > 0 ? m.topLeftCorner(nuisance, nuisance).ldlt().vectorD().array().log().sum() : 0.0);
    EXPECT_LE(log_det, design.bound);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Bounds,
                         testing::Values(Case{1, 5, 0, 10}, Case{1, 6, 2, 20}, Case{3, 9, 0, 8}, Case{3, 9, 4, 12},
                                         Case{1, 4, 0, 299}, Case{2, 4, 0, 300}));

TEST(ApproximateDesign, TraceCriteriaAreBoundedTooWithCapsAndPriors) {
  for (const int rows : {1, 3})
    for (const double cap : {1.0, 0.1, 0.15})
      for (const bool known : {false, true}) {
        BlockArray blocks = random_blocks(200, rows, 6, 9);
        whiten(blocks);
        const TraceFunction function(random_blocks(1, 4, 6, 3).block(0));
        ApproximateDesignOptions options;
        options.cap = cap;
        if (known) options.prior = 0.3 * Eigen::MatrixXd::Identity(6, 6);
        const ApproximateDesign design = solve_approximate_design(blocks, function, options, Monitor{});
        EXPECT_LE(design.max_sensitivity_ratio, 1 + 1e-6) << rows << " " << cap << " " << known;
        Random random(8, 0);
        for (int trial = 0; trial < 200; ++trial) {
          // As many alike as the cap asks for; a partial one where 1/cap is not a whole number.
          Eigen::MatrixXd M = known ? options.prior : Eigen::MatrixXd::Zero(6, 6);
          std::vector<int> order(200);
          std::iota(order.begin(), order.end(), 0);
          double left = 1.0;
          for (std::size_t i = 0; left > 1e-12; ++i) {
            std::swap(order[i], order[i + std::size_t(random.index(int(200 - i)))]);
            const double w = std::min({left, cap, cap == 1.0 ? random.uniform(0.02, 0.3) : cap});
            M += w * blocks.block(std::size_t(order[i])).transpose() * blocks.block(std::size_t(order[i]));
            left -= w;
          }
          EXPECT_LE(function.value(M), design.bound);
        }
      }
}

TEST(ApproximateDesign, AOptimalQuadraticHasTheKnownWeights) {
  // A-optimality for 1, x, x² on [−1, 1]: weights 1/4, 1/2, 1/4 at −1, 0, 1, trace 8 (Pukelsheim 1993, ch. 9).
  const BlockArray blocks = quadratic(101);
  const TraceFunction function(Eigen::MatrixXd::Identity(3, 3));
  const ApproximateDesign design = solve_approximate_design(blocks, function, {}, Monitor{});
  EXPECT_NEAR(std::exp(-design.value), 8, 1e-6);
  EXPECT_NEAR(weight_of(design, 0), 0.25, 1e-4);
  EXPECT_NEAR(weight_of(design, 50), 0.5, 1e-4);
}

TEST(ApproximateDesign, SeveralVariantsAreBoundedByTheirWorst) {
  const BlockArray blocks = random_blocks(150, 2, 8, 14);
  CriterionData data{Eigen::MatrixXd::Identity(8, 8), Eigen::VectorXd::Ones(8), 0};
  data.variants = {{0, 4, 0, 1.0, 1.0}, {4, 4, 1, 2.0, 3.0}};
  for (const char* name : {"compound", "maximin"}) {
    const auto criterion = make_criterion(name, data);
    const ApproximateDesign design = solve_approximate_design(blocks, criterion->function(), {}, Monitor{});
    EXPECT_LE(design.max_sensitivity_ratio, 1.001) << name;
    Eigen::MatrixXd best = Eigen::MatrixXd::Zero(8, 8);
    for (std::size_t i = 0; i < design.support.size(); ++i) {
      const auto block = blocks.block(std::size_t(design.support[i]));
      best += design.weights[i] * block.transpose() * block;
    }
    EXPECT_GT(criterion->function().value(best), design.bound - 0.02) << name << ": the bound is of use";
    Random random(2, 0);
    for (int trial = 0; trial < 300; ++trial) {
      Eigen::MatrixXd M = Eigen::MatrixXd::Zero(8, 8);
      double total = 0;
      for (int i = 0; i < 12; ++i) {
        const double w = random.uniform();
        const auto block = blocks.block(std::size_t(random.index(150)));
        M += w * block.transpose() * block;
        total += w;
      }
      EXPECT_LE(criterion->function().value(M / total), design.bound) << name;
    }
  }
}

TEST(ApproximateDesign, DependentColumnsAreAnErrorNotANumber) {
  BlockArray blocks = random_blocks(50, 1, 4, 3);
  for (std::size_t i = 0; i < 50; ++i) blocks.row(i, 0)[3] = 2 * blocks.row(i, 0)[0] - blocks.row(i, 0)[2];
  EXPECT_THROW(whiten(blocks), CannotDo);
}

TEST(Whiten, MeanInformationBecomesIdentityAndRRestoresTheBlocks) {
  const BlockArray raw = random_blocks(200, 2, 9, 12);
  BlockArray white = random_blocks(200, 2, 9, 12);
  for (std::size_t i = 0; i < 200; ++i) white.block(i).col(4) *= 1e6;
  const Whitening whitening = whiten(white);
  const Eigen::MatrixXd m = white.all().transpose() * white.all() / 200.0;
  EXPECT_LT((m - Eigen::MatrixXd::Identity(9, 9)).cwiseAbs().maxCoeff(), 1e-12);
  Eigen::MatrixXd restored = white.block(7) * whitening.R;
  restored.col(4) /= 1e6;
  EXPECT_LT((restored - raw.block(7)).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace posewright
