#include "src/criterion/kernels/bounds.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "posewright/support/dense.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

struct Drawn {
  static constexpr int rows = 5, columns = 21, nuisance = 6;
  static constexpr std::size_t count = 200;
};

struct Set {
  const BoundKernels* kernels;
  const char* name;
};

std::vector<Set> runnable() {
  std::vector<Set> sets = {{&bounds_sse2, "sse2"}};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) sets.push_back({&bounds_avx2, "avx2"});
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    sets.push_back({&bounds_avx512, "avx512"});
#endif
  return sets;
}

/// Blocks whose columns nearly depend on each other, so that products with L⁻ᵀ cancel.
BlockArray nearly_dependent() {
  BlockArray blocks = random_blocks(Drawn::count, Drawn::rows, Drawn::columns, 5);
  for (int j = 1; j < Drawn::columns; ++j)
    blocks.all().col(j) = blocks.all().col(0) + 1e-3 * Eigen::VectorXd(blocks.all().col(j));
  return blocks;
}

/// L⁻ᵀ of the information of the first 20 blocks.
Eigen::MatrixXd inverse_factor(const BlockArray& blocks) {
  const Eigen::MatrixXd J = blocks.all().topRows(20 * Drawn::rows);
  const Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd(J.transpose() * J));
  return factor.matrixU().solve(Eigen::MatrixXd::Identity(Drawn::columns, Drawn::columns));
}

/// Some columns of a matrix as the kernels read them.
struct Single {
  explicit Single(const Eigen::MatrixXd& T, int leading) : data(std::size_t(T.rows()) * stride(T), 0.0F) {
    for (Eigen::Index i = 0; i < T.rows(); ++i)
      for (Eigen::Index j = 0; j < T.cols(); ++j) data[std::size_t(i) * stride(T) + std::size_t(j)] = float(T(i, j));
    const double error = double(T.rows() + 8) * 0x1p-24 * T.norm();
    view = {data.data(), int(T.rows()), int(T.cols()), int(stride(T)), leading, error};
  }
  static std::size_t stride(const Eigen::MatrixXd& T) { return std::size_t(T.cols() + 15) / 16 * 16; }

  std::vector<float> data;
  SingleMatrix view = {};
};

std::vector<double> sizes(const BlockArray& blocks) {
  std::vector<double> size;
  for (std::size_t j = 0; j < blocks.count(); ++j) size.push_back(blocks.block(j).norm());
  return size;
}

TEST(Bounds, TracesAreNoLessThanTheExactOnesAndNear) {
  const BlockArray blocks = nearly_dependent();
  const Eigen::MatrixXd T = inverse_factor(blocks).rightCols(Drawn::columns - Drawn::nuisance);
  const Single single(T, Drawn::nuisance);
  const std::vector<double> size = sizes(blocks);
  for (const Set& set : runnable()) {
    std::vector<double> d(Drawn::count);
    std::vector<float> scratch(std::size_t(3 * blocks.stride()));
    set.kernels->traces(blocks.data(), Drawn::count, Drawn::rows, blocks.stride(), size.data(), single.view,
                        scratch.data(), d.data());
    for (std::size_t j = 0; j < Drawn::count; ++j) {
      const double exact = (blocks.block(j) * T).squaredNorm();
      EXPECT_GE(d[j], exact) << set.name;
      EXPECT_LE(d[j], 1.05 * exact) << set.name;
    }
  }
}

TEST(Bounds, NoBlockIsPassedOverThatMayBeMore) {
  const BlockArray blocks = nearly_dependent();
  const Eigen::MatrixXd whole = inverse_factor(blocks);
  const Eigen::MatrixXd P = whole * Eigen::MatrixXd(random_blocks(1, Drawn::columns, Drawn::rows, 7).all());
  const Eigen::MatrixXd Q = 0.3 * P.topRows(Drawn::nuisance);
  const Single plus(P, Drawn::columns), minus(Q, Drawn::nuisance), none(Eigen::MatrixXd(0, 0), 0);
  const std::vector<double> size = sizes(blocks);
  std::vector<unsigned char> blocked(Drawn::count, 0);
  blocked[3] = 1;
  for (const Set& set : runnable())
    for (const bool has_minus : {true, false}) {
      std::vector<double> d(Drawn::count), sums(Drawn::count);
      std::vector<float> scratch(std::size_t(3 * blocks.stride()));
      for (std::size_t j = 0; j < Drawn::count; ++j) {
        d[j] = 0.01 * double(j);
        sums[j] = d[j] + (blocks.block(j) * P).squaredNorm();
        if (has_minus) sums[j] -= (blocks.block(j).leftCols(Drawn::nuisance) * Q).squaredNorm();
      }
      int stops = 0, counted = 0;
      for (std::size_t at = 0; at < Drawn::count; at += 7) {
        const double least = sums[at] * (1 - 1e-12);
        std::vector<bool> found(Drawn::count, false);
        for (std::size_t j = 0;; ++j) {
          j = set.kernels->next_between(blocks.data(), j, Drawn::count, Drawn::rows, blocks.stride(), size.data(),
                                        plus.view, has_minus ? minus.view : none.view, d.data(), blocked.data(), 0.1,
                                        least, scratch.data());
          if (j >= Drawn::count) break;
          found[j] = true;
          ++stops;
        }
        for (std::size_t j = 0; j < Drawn::count; ++j) {
          const bool counts = blocked[j] == 0 && d[j] > 0.1 && sums[j] > least;
          counted += counts ? 1 : 0;
          EXPECT_TRUE(found[j] || !counts) << set.name << " " << j;
          EXPECT_FALSE(found[j] && (blocked[j] != 0 || d[j] <= 0.1)) << set.name << " " << j;
        }
      }
      EXPECT_LE(stops, counted + counted / 20) << set.name;
    }
}

}  // namespace
}  // namespace posewright
