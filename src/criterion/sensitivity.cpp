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

/// ‖x T‖² of the leading columns, by stretches of blocks: what each gets does not depend on its neighbours.
void pass(const BlockArray& blocks, const Eigen::MatrixXd& T, int columns, int threads, std::vector<double>& d) {
  d.resize(blocks.count());
  const int stride = (columns + 15) / 16 * 16;
  const std::vector<double> t = tiled(T, columns, stride);
  constexpr std::size_t chunk = 4096;
  parallel_for((blocks.count() + chunk - 1) / chunk, threads, [&](std::size_t c, int) {
    const std::size_t first = c * chunk, count = std::min(chunk, blocks.count() - first);
    kernels().traces(blocks.row(first, 0), count, blocks.rows(), blocks.stride(), t.data(), stride, columns,
                     d.data() + first);
  });
}

}  // namespace

void information_traces(const BlockArray& blocks, const Eigen::MatrixXd& inverse_factor, int columns,
                        std::vector<double>& d, int threads) {
  pass(blocks, inverse_factor.transpose(), columns, threads, d);
}

void sensitivities(const BlockArray& blocks, const Eigen::MatrixXd& T, int threads, std::vector<double>& d) {
  pass(blocks, T, blocks.columns(), thread_count(threads), d);
}

void keep_largest(std::vector<int>& candidates, const std::vector<double>& d, std::size_t count) {
  count = std::min(count, candidates.size());
  std::partial_sort(candidates.begin(), candidates.begin() + std::ptrdiff_t(count), candidates.end(),
                    [&](int a, int b) {
                      return d[std::size_t(a)] != d[std::size_t(b)] ? d[std::size_t(a)] > d[std::size_t(b)] : a < b;
                    });
  candidates.resize(count);
}

}  // namespace posewright
