#include "posewright/criterion/sensitivity.hpp"

#include "kernels/kernels.hpp"

namespace posewright {

void information_traces(const BlockArray& blocks, const Eigen::MatrixXd& inverse_factor, int columns,
                        std::vector<double>& d) {
  d.resize(blocks.count());
  const int t_stride = (columns + 15) / 16 * 16;
  std::vector<double> t(std::size_t(columns * t_stride));
  for (int k = 0; k < columns; ++k)
    for (int i = k; i < columns; ++i) t[std::size_t(k * t_stride + i)] = inverse_factor(i, k);
  kernels().traces(blocks.data(), blocks.count(), blocks.rows(), blocks.stride(), t.data(), t_stride, columns,
                   d.data());
}

void sensitivities(const BlockArray& blocks, int nuisance, const Eigen::MatrixXd& inverse_factor,
                   std::vector<double>& d) {
  information_traces(blocks, inverse_factor, blocks.columns(), d);
  if (nuisance == 0) return;
  std::vector<double> own;
  information_traces(blocks, inverse_factor, nuisance, own);
  for (std::size_t i = 0; i < d.size(); ++i) d[i] -= own[i];
}

}  // namespace posewright
