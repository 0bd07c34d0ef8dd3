#include "posewright/criterion/sensitivity.hpp"

#include <algorithm>

#include "kernels/kernels.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {

namespace {

/// Rows of T as the kernel reads them: padded to tiles of 16.
std::vector<double> tiled(const Eigen::MatrixXd& T, int columns, int stride) {
  std::vector<double> t(std::size_t(columns * stride));
  for (int k = 0; k < columns; ++k)
    for (int i = k; i < columns; ++i) t[std::size_t(k * stride + i)] = T(k, i);
  return t;
}

}  // namespace

void information_traces(const BlockArray& blocks, const Eigen::MatrixXd& inverse_factor, int columns,
                        std::vector<double>& d) {
  d.resize(blocks.count());
  const int stride = (columns + 15) / 16 * 16;
  const std::vector<double> t = tiled(inverse_factor.transpose(), columns, stride);
  kernels().traces(blocks.data(), blocks.count(), blocks.rows(), blocks.stride(), t.data(), stride, columns, d.data());
}

void sensitivities(const BlockArray& blocks, const Eigen::MatrixXd& T, int threads, std::vector<double>& d) {
  d.resize(blocks.count());
  const int columns = blocks.columns(), stride = (columns + 15) / 16 * 16;
  const std::vector<double> t = tiled(T, columns, stride);
  constexpr std::size_t chunk = 4096;
  parallel_for((blocks.count() + chunk - 1) / chunk, thread_count(threads), [&](std::size_t c, int) {
    const std::size_t first = c * chunk, count = std::min(chunk, blocks.count() - first);
    kernels().traces(blocks.row(first, 0), count, blocks.rows(), blocks.stride(), t.data(), stride, columns,
                     d.data() + first);
  });
}

}  // namespace posewright
