#pragma once

#include <Eigen/Dense>
#include <vector>

namespace posewright {

/// A place where accuracy after compensation matters: position error = A · (error of the parameters).
struct TestPoint {
  Eigen::MatrixXd A;    ///< rows × m, raw coordinates (SI), zero for nuisance columns
  double weight = 1.0;  ///< > 0
};

/// What criteria need beyond the blocks. Blocks are whitened, J = J_raw R⁻¹, so M_raw = Rᵀ M R.
struct CriterionData {
  Eigen::MatrixXd R;                     ///< m × m, upper triangular; see planning/whiten.hpp
  Eigen::VectorXd scale;                 ///< unit of every parameter (its tolerance, …), raw coordinates
  int nuisance = 0;                      ///< leading nuisance columns
  std::vector<TestPoint> test_points{};  ///< for test_pose, test_pose_max

  /// R · diag(scale): M in units of `scale` is Cᵀ M C.
  Eigen::MatrixXd to_scaled() const { return R * scale.asDiagonal(); }
};

}  // namespace posewright
