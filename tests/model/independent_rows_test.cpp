#include "posewright/model/independent_rows.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

namespace posewright {
namespace {

Eigen::MatrixXd drawn(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

TEST(IndependentRows, WhitenByTheCovarianceOfAllReadings) {
  // A column that is large, and one that repeats another.
  Eigen::MatrixXd F = drawn(12, 5, 1);
  F.col(1) *= 1e4;
  F.col(2) = F.col(3);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(12, 12);
  Eigen::MatrixXd W = one, transposed = one;
  IndependentRows(F).apply(W);
  IndependentRows(F).apply_transposed(transposed);
  EXPECT_LT((W * (one + F * F.transpose()) * W.transpose() - one).norm(), 1e-6);
  EXPECT_LT((W.transpose() - transposed).norm(), 1e-12);
}

TEST(IndependentRows, MakeAVectorTheSameAsAColumn) {
  const Eigen::MatrixXd F = drawn(8, 3, 2);
  Eigen::MatrixXd columns = drawn(8, 2, 3);
  Eigen::VectorXd last = columns.col(1);
  IndependentRows(F).apply(columns);
  IndependentRows(F).apply(last);
  EXPECT_LT((last - columns.col(1)).norm(), 1e-14);
}

// Second road: F by its definition, a number at a time. Poses of one to four readings, two tips of six twists.
TEST(EffectRows, MultiplyAsTheMatrixTheyAre) {
  constexpr int features = 5, tips = 2, twists = 6;
  const std::vector<int> first{0, 4, 5, 8, 8, 10};
  const Eigen::MatrixXd phi = drawn(features, 5 * tips, 4), along = drawn(10, tips * twists, 5);
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(10, features * twists);
  for (int pose = 0; pose < 5; ++pose)
    for (int row = first[std::size_t(pose)]; row < first[std::size_t(pose) + 1]; ++row)
      for (int j = 0; j < features; ++j)
        for (int tip = 0; tip < tips; ++tip)
          for (int k = 0; k < twists; ++k)
            F(row, j * twists + k) += phi(j, pose * tips + tip) * along(row, tip * twists + k);
  const EffectRows rows(phi, along, first);
  const Eigen::MatrixXd X = drawn(10, 3, 6), Y = drawn(features * twists, 3, 7);
  EXPECT_LT((rows.dense() - F).norm(), 1e-13);
  EXPECT_LT((rows.products() - F.transpose() * F).norm(), 1e-12);
  EXPECT_LT((rows.transposed_times(X) - F.transpose() * X).norm(), 1e-12);
  EXPECT_LT((rows.times(Y) - F * Y).norm(), 1e-12);
  Eigen::MatrixXd whole = X, in_parts = X;
  IndependentRows(F).apply(whole);
  IndependentRows(rows).apply(in_parts);
  EXPECT_LT((whole - in_parts).norm(), 1e-11);
}

}  // namespace
}  // namespace posewright
