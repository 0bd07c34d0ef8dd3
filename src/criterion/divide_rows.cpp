#include "posewright/criterion/divide_rows.hpp"

#include <algorithm>

#include "kernels/kernels.hpp"

namespace posewright {

RowDivisor::RowDivisor(const Eigen::MatrixXd& R) : columns_(int(R.cols())), stride_((columns_ + 7) / 8 * 8) {
  above_.assign(std::size_t(columns_) * std::size_t(stride_), 0.0);
  for (int j = 0; j < columns_; ++j) {
    diagonal_.push_back(R(j, j));
    for (int k = j + 1; k < columns_; ++k) above_[std::size_t(j * stride_ + k)] = R(j, k);
  }
}

void RowDivisor::divide(Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> rows) {
  padded_.assign(std::size_t(rows.rows() * stride_), 0.0);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    std::copy_n(rows.row(i).data(), columns_, padded_.data() + i * stride_);
  kernels().divide_rows(padded_.data(), int(rows.rows()), stride_, above_.data(), diagonal_.data(), columns_);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    std::copy_n(padded_.data() + i * stride_, columns_, rows.row(i).data());
}

}  // namespace posewright
