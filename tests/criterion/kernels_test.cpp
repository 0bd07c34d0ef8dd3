#include "src/criterion/kernels/kernels.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "posewright/criterion/divide_rows.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

std::vector<const Kernels*> runnable() {
  std::vector<const Kernels*> sets = {&kernels_sse2};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) sets.push_back(&kernels_avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) sets.push_back(&kernels_avx512);
#endif
  return sets;
}

/// Everything the kernels compute on one random input.
std::vector<double> all_results(const Kernels& kernels, int rows, int columns) {
  const BlockArray blocks = random_blocks(33, rows, columns, 5), y = random_blocks(1, 5, columns, 6);
  const int stride = blocks.stride(), t_stride = (columns + 15) / 16 * 16;
  std::vector<double> t(std::size_t(columns * t_stride));
  Random random(8, 0);
  for (int k = 0; k < columns; ++k)
    for (int i = k; i < columns; ++i) t[std::size_t(k * t_stride + i)] = random.uniform(-1, 1);
  const std::vector<double> sign = {1, -1, 1, 1, -1};
  std::vector<double> traces(33), reduced(33, 2.0), cross(std::size_t(5 * rows));
  kernels.traces(blocks.data(), 33, rows, stride, t.data(), t_stride, columns, traces.data());
  kernels.subtract_squares(blocks.data(), 33, rows, stride, y.data(), sign.data(), 5, reduced.data());
  kernels.cross(blocks.data(), rows, stride, y.data(), 5, cross.data());
  double best = 0;
  std::vector<unsigned char> blocked(33, 0);
  std::vector<double> d(traces);
  const long found =
      rows == 1 ? kernels.scan_rows(blocks.data(), 33, stride, y.data(), d.data(), 0.5, blocked.data(), &best) : 0;
  std::vector<double> all = traces;
  all.insert(all.end(), reduced.begin(), reduced.end());
  all.insert(all.end(), cross.begin(), cross.end());
  all.push_back(best);
  all.push_back(double(found));
  std::vector<double> products(33 * 33, 0.0);
  kernels.gram(blocks.data(), 33, stride, products.data());
  all.insert(all.end(), products.begin(), products.end());
  BlockArray divided = random_blocks(1, rows, columns, 3);
  std::vector<double> above(std::size_t(columns * stride), 0.0), diagonal;
  for (int j = 0; j < columns; ++j) {
    diagonal.push_back(random.uniform(0.5, 2));
    for (int k = j + 1; k < columns; ++k) above[std::size_t(j * stride + k)] = random.uniform(-1, 1) / columns;
  }
  kernels.divide_rows(divided.data(), rows, stride, above.data(), diagonal.data(), columns);
  all.insert(all.end(), divided.data(), divided.data() + rows * stride);
  return all;
}

TEST(Kernels, EveryInstructionSetGivesTheSameBits) {
  for (const int rows : {1, 3, 9})
    for (const int columns : {1, 7, 8, 16, 17, 33, 42}) {
      const std::vector<double> reference = all_results(kernels_sse2, rows, columns);
      for (const Kernels* set : runnable())
        EXPECT_EQ(all_results(*set, rows, columns), reference) << set->name << " " << rows << "x" << columns;
    }
}

TEST(Kernels, TracesEqualMatrixProducts) {
  const BlockArray blocks = random_blocks(10, 3, 19, 2);
  Eigen::MatrixXd t = Eigen::MatrixXd(random_blocks(1, 19, 19, 3).all()).triangularView<Eigen::Upper>();
  std::vector<double> padded(19 * 32), d(10);
  for (int k = 0; k < 19; ++k)
    for (int i = 0; i < 19; ++i) padded[std::size_t(k * 32 + i)] = t(k, i);
  kernels().traces(blocks.data(), 10, 3, blocks.stride(), padded.data(), 32, 19, d.data());
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(d[i], (blocks.block(i) * t).squaredNorm(), 1e-12 * d[i]);
}

TEST(Kernels, DividedRowsTimesTheDivisorAreTheRows) {
  for (const int rows : {1, 2, 3, 4, 9})
    for (const int columns : {1, 3, 8, 13, 33}) {
      const Eigen::MatrixXd R =
          (Eigen::MatrixXd(random_blocks(1, columns, columns, 8).all()) / columns).triangularView<Eigen::Upper>();
      const Eigen::MatrixXd divisor = R + Eigen::MatrixXd::Identity(columns, columns);
      const BlockArray::RowMatrix x = random_blocks(1, rows, columns, 9).all();
      BlockArray::RowMatrix divided = x;
      RowDivisor(divisor).divide(divided);
      EXPECT_LT((divided * divisor - x).cwiseAbs().maxCoeff(), 1e-13 * x.cwiseAbs().maxCoeff()) << columns;
    }
}

TEST(Kernels, GramIsTheProductWithTheTransposedInItsLowerTriangle) {
  for (const int rows : {1, 2, 3, 7, 20}) {
    const BlockArray blocks = random_blocks(std::size_t(rows), 1, 13, 4);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(rows, rows);
    kernels().gram(blocks.data(), std::size_t(rows), blocks.stride(), H.data());
    const Eigen::MatrixXd expected = blocks.all() * blocks.all().transpose();
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j <= i; ++j) EXPECT_NEAR(H(i, j), expected(i, j), 1e-13);
  }
}

}  // namespace
}  // namespace posewright
