#pragma once

#include <Eigen/Core>
#include <vector>

namespace posewright {

/// Divides rows by an upper triangular matrix R: x R⁻¹. Every processor gives the same bits.
class RowDivisor {
 public:
  explicit RowDivisor(const Eigen::MatrixXd& R);
  /// @param rows  each as long as R is wide
  void divide(Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> rows);

 private:
  int columns_, stride_;
  std::vector<double> above_, diagonal_, padded_;
};

}  // namespace posewright
