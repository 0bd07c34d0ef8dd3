#include "posewright/model/unmodelled_effect.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

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

}  // namespace
}  // namespace posewright
