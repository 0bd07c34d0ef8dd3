#include "posewright/criterion/combine_rows.hpp"

#include <vector>

#include "kernels/kernels.hpp"

namespace posewright {

void combine_rows(const double* in, double* out, std::size_t outer, std::size_t stride, const Eigen::MatrixXd& M) {
  static thread_local std::vector<double> rows;
  rows.resize(std::size_t(M.size()));
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(rows.data(), M.rows(), M.cols()) =
      M;
  kernels().combine_rows(in, out, outer, stride, rows.data(), int(M.rows()), int(M.cols()));
}

}  // namespace posewright
