#include "posewright/support/dense.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "posewright/support/random.hpp"
#include "src/support/panels/panels.hpp"

namespace posewright {
namespace {

Eigen::MatrixXd drawn(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  Random random(seed, 0);
  Eigen::MatrixXd result(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) result(i, j) = random.uniform(-1, 1);
  return result;
}

/// The definition, entry by entry.
Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  Eigen::MatrixXd C(A.rows(), B.cols());
  for (Eigen::Index i = 0; i < C.rows(); ++i)
    for (Eigen::Index j = 0; j < C.cols(); ++j) {
      double sum = 0;
      for (Eigen::Index k = 0; k < A.cols(); ++k) sum += A(i, k) * B(k, j);
      C(i, j) = sum;
    }
  return C;
}

double largest_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

TEST(Dense, ProductsOfAnyShapeAreSumsOfProducts) {
  for (const int rows : {1, 2, 3, 5, 8, 13, 31, 47, 64, 101})
    for (const int columns : {1, 2, 4, 7, 30, 65})
      for (const int depth : {1, 3, 24, 77, 700}) {
        const Eigen::MatrixXd A = drawn(rows, depth, 1), B = drawn(depth, columns, 2);
        const Eigen::MatrixXd expected = product(A, B);
        const double rounding = 1e-14 * depth;
        Eigen::MatrixXd C = Eigen::MatrixXd::Ones(rows, columns);
        C.noalias() += 2 * A * B;
        EXPECT_LT(largest_difference(C, (2 * expected).array() + 1), 4 * rounding);
        const Eigen::Matrix<double, -1, -1, Eigen::RowMajor> by_rows = A;
        C.noalias() = by_rows * B;
        EXPECT_LT(largest_difference(C, expected), rounding);
        const Eigen::MatrixXd turned = B.transpose() * A.transpose();
        EXPECT_LT(largest_difference(turned.transpose(), expected), rounding);
      }
}

// Eigen would cut after as many as the processor's first cache holds.
TEST(Dense, LongSumsAreCutAtTheSamePlacesOnEveryProcessor) {
  constexpr Eigen::Index depth = 2000, part = 504;
  const Eigen::MatrixXd A = drawn(8, depth, 3), B = drawn(depth, 8, 4);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(8, 8);
  for (Eigen::Index k = 0; k < depth; k += part) {
    const Eigen::Index size = std::min(part, depth - k);
    expected += product(A.middleCols(k, size), B.middleRows(k, size));
  }
  Eigen::MatrixXd C(8, 8);
  C.noalias() = A * B;
  EXPECT_EQ(largest_difference(C, expected), 0);
}

TEST(Dense, PartsOfMatricesAreMultipliedAndNothingBesideThemIsWritten) {
  const Eigen::MatrixXd A = drawn(60, 50, 3), B = drawn(50, 40, 4);
  Eigen::MatrixXd C = Eigen::MatrixXd::Constant(70, 70, 7.0);
  C.block(5, 9, 37, 22).noalias() = A.block(3, 2, 37, 41) * B.block(1, 8, 41, 22);
  EXPECT_LT(largest_difference(C.block(5, 9, 37, 22), product(A.block(3, 2, 37, 41), B.block(1, 8, 41, 22))), 1e-12);
  C.block(5, 9, 37, 22).setConstant(7.0);
  EXPECT_EQ(C, Eigen::MatrixXd::Constant(70, 70, 7.0));
}

TEST(Dense, FactorsAndSolutionsGiveBackWhatTheyAreOf) {
  for (const int size : {1, 4, 17, 50, 131, 300}) {
    const Eigen::MatrixXd X = drawn(2 * size, size, 5);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(size, size);
    M.selfadjointView<Eigen::Lower>().rankUpdate(X.transpose());
    M.triangularView<Eigen::StrictlyUpper>() = M.transpose();
    EXPECT_LT(largest_difference(M, product(X.transpose(), X)), 1e-12 * size);
    const Eigen::LLT<Eigen::MatrixXd> factor(M);
    const Eigen::MatrixXd L = factor.matrixL();
    EXPECT_LT(largest_difference(product(L, L.transpose()), M), 1e-12 * size);
    const Eigen::MatrixXd B = drawn(size, 9, 6), Y = factor.matrixL().solve(B), Z = factor.solve(B);
    EXPECT_LT(largest_difference(product(L, Y), B), 1e-10);
    EXPECT_LT(largest_difference(product(M, Z), B), 1e-8);
  }
}

#if defined(__x86_64__) && !defined(__AVX__) && !defined(__FMA__) && !EIGEN_VERSION_AT_LEAST(3, 4, 90)

/// Eigen's own loop: of matrices that are indexed by int, which nothing takes the place of.
using EigensOwn =
    Eigen::internal::gebp_kernel<double, double, int, Eigen::internal::blas_data_mapper<double, int, Eigen::ColMajor>,
                                 4, 4, false, false>;

std::vector<MultiplyPanels*> runnable() {
  std::vector<MultiplyPanels*> sets = {multiply_panels_sse2};
  if (__builtin_cpu_supports("avx2")) sets.push_back(multiply_panels_avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) sets.push_back(multiply_panels_avx512);
  return sets;
}

TEST(Dense, EveryInstructionSetMultipliesPanelsToTheBitsOfEigensOwnLoop) {
  const Eigen::MatrixXd numbers = drawn(90 * 90, 1, 7);
  const double *a = numbers.data(), *b = numbers.data() + 100;
  for (const int rows : {1, 2, 3, 4, 7, 12, 30, 35, 67})
    for (const int columns : {1, 4, 6, 11})
      for (const int depth : {1, 7, 8, 31, 80}) {
        const PanelProduct size{rows, depth, columns, 0.7, depth + 3, depth + 2, 2, 1};
        std::vector<double> expected(std::size_t(columns) * 80, 1.0);
        EigensOwn()({expected.data(), 80}, a, b, rows, depth, columns, 0.7, depth + 3, depth + 2, 2, 1);
        for (MultiplyPanels* multiply : runnable()) {
          std::vector<double> c(std::size_t(columns) * 80, 1.0);
          multiply(c.data(), 80, a, b, size);
          EXPECT_EQ(c, expected) << rows << " x " << depth << " x " << columns;
        }
      }
}

#endif

}  // namespace
}  // namespace posewright
