#include "posewright/planning/alias.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "posewright/support/error.hpp"
#include "tests/kit/plackett_burman.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

Eigen::MatrixXd alias_matrix(const BlockArray& blocks, int own, const Eigen::VectorXd& known = {}) {
  return fit_aliases(blocks, own, known).taken;
}

constexpr int runs = plackett_burman_runs, factors = plackett_burman_factors, pairs = factors * (factors - 1) / 2;

TEST(Alias, PlackettBurmanSharesEachInteractionAmongTheFourOtherFactorsByAThird) {
  const BlockArray blocks = plackett_burman();
  const Eigen::MatrixXd main = blocks.all().leftCols(1 + factors);
  ASSERT_NEAR(std::log((main.transpose() * main).determinant()), (1 + factors) * std::log(double(runs)), 1e-10);
  const Eigen::MatrixXd a = alias_matrix(blocks, 1 + factors);
  ASSERT_EQ(a.rows(), 1 + factors);
  ASSERT_EQ(a.cols(), pairs);
  for (int j = 0, pair = 0; j < factors; ++j)
    for (int k = j + 1; k < factors; ++k, ++pair) {
      EXPECT_NEAR(a(0, pair), 0, 1e-14);
      for (int f = 0; f < factors; ++f)
        EXPECT_NEAR(std::abs(a(1 + f, pair)), f == j || f == k ? 0 : 1.0 / 3, 1e-14) << f << " of " << j << k;
    }
  EXPECT_NEAR((a.transpose() * a).trace(), 20.0 / 3, 1e-12);
}

TEST(Alias, AgreesWithTheNormalEquations) {
  const BlockArray blocks = random_blocks(9, 3, 8, 1);
  const Eigen::MatrixXd x1 = blocks.all().leftCols(5), x2 = blocks.all().rightCols(3);
  const Eigen::MatrixXd expected = (x1.transpose() * x1).inverse() * x1.transpose() * x2;
  EXPECT_LT((alias_matrix(blocks, 5) - expected).norm(), 1e-12);
}

TEST(Alias, AColumnThatIsFittedTooIsExplainedByItself) {
  BlockArray blocks = random_blocks(9, 3, 6, 2);
  for (std::size_t i = 0; i < blocks.count(); ++i) blocks.block(i).col(5) = -2 * blocks.block(i).col(3);
  EXPECT_LT((alias_matrix(blocks, 5) + 2 * Eigen::VectorXd::Unit(5, 3)).norm(), 1e-13);
}

TEST(Alias, EliminatingNuisanceGivesTheRowsOfTheFullSolution) {
  const int nuisance = 3, interest = 4;
  const BlockArray blocks = random_blocks(10, 2, nuisance + interest + 2, 3);
  const Eigen::MatrixXd n = blocks.all().leftCols(nuisance);
  const Eigen::MatrixXd rest = blocks.all().rightCols(interest + 2);
  const Eigen::MatrixXd outside = rest - n * (n.transpose() * n).inverse() * n.transpose() * rest;
  BlockArray eliminated(10, 2, interest + 2);
  eliminated.all() = outside;
  EXPECT_LT(
      (alias_matrix(blocks, nuisance + interest).bottomRows(interest) - alias_matrix(eliminated, interest)).norm(),
      1e-12);
}

TEST(Alias, UnitsOfColumnsComeOut) {
  BlockArray blocks = random_blocks(9, 3, 6, 4);
  const Eigen::MatrixXd before = alias_matrix(blocks, 4);
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    blocks.block(i).col(1) *= 1e7;
    blocks.block(i).col(5) *= 1e3;
  }
  const Eigen::MatrixXd after = alias_matrix(blocks, 4);
  EXPECT_NEAR(after(1, 0) * 1e7, before(1, 0), 1e-12);
  EXPECT_NEAR(after(0, 1) * 1e-3, before(0, 1), 1e-12);
  EXPECT_NEAR(after(1, 1) * 1e4, before(1, 1), 1e-12);
}

TEST(Alias, KnowledgeFromBeforeIsOneMoreReadingOfEachColumn) {
  const BlockArray blocks = random_blocks(9, 3, 6, 5);
  const Eigen::VectorXd sigma = Eigen::VectorXd::LinSpaced(4, 0.2, 0.8);
  const Eigen::MatrixXd x1 = blocks.all().leftCols(4), x2 = blocks.all().rightCols(2);
  const Eigen::MatrixXd precision = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  const Eigen::MatrixXd expected = (x1.transpose() * x1 + precision).inverse() * x1.transpose() * x2;
  EXPECT_LT((alias_matrix(blocks, 4, sigma) - expected).norm(), 1e-12);
}

TEST(Alias, DependentColumnsAndSizesThatDoNotFitAreRefused) {
  BlockArray blocks = random_blocks(9, 3, 6, 6);
  EXPECT_THROW(alias_matrix(blocks, 7), std::invalid_argument);
  EXPECT_THROW(alias_matrix(blocks, 0), std::invalid_argument);
  EXPECT_THROW(alias_matrix(blocks, 4, Eigen::VectorXd::Ones(3)), std::invalid_argument);
  EXPECT_THROW(alias_matrix(random_blocks(1, 3, 6, 7), 5), CannotDo);
  for (std::size_t i = 0; i < blocks.count(); ++i) blocks.block(i).col(2) = 3 * blocks.block(i).col(1);
  EXPECT_THROW(alias_matrix(blocks, 4), CannotDo);
  for (std::size_t i = 0; i < blocks.count(); ++i) blocks.block(i).col(2).setZero();
  EXPECT_THROW(alias_matrix(blocks, 4), CannotDo);
}

}  // namespace
}  // namespace posewright
