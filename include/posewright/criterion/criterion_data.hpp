#pragma once

#include <Eigen/Core>
#include <vector>

namespace posewright {

/// A place where accuracy after compensation matters: position error = A · (error of the parameters).
struct TestPoint {
  Eigen::MatrixXd A;       ///< rows × m, raw coordinates (SI), zero for nuisance columns
  double weight = 1.0;     ///< > 0
  Eigen::MatrixXd turn{};  ///< 3 × m: the same of the orientation (rotation vector), for the figures of a plan
};

/// One of several variants that a plan serves at once: its columns in the blocks.
struct VariantGroup {
  int first = 0, columns = 0;
  int nuisance = 0;        ///< its leading columns that are nuisance
  double weight = 1.0;     ///< > 0, for compound
  double reference = 0.0;  ///< log det of its interest information that no plan of as many poses exceeds, whitened
};

/// Effects of an alternative variant that the fitted one lacks. The trailing columns of the blocks span what its
/// effects do to the readings beyond what the fitted columns, all others, imitate over the candidates. Effects are
/// independent of one another, each of size one.
struct EffectGroup {
  int columns = 0;      ///< trailing ones; 0: no effects are known
  Eigen::MatrixXd mix;  ///< columns × effects, raw: effect e moves the readings by (trailing columns) mix.col(e)
  Eigen::MatrixXd error_rows{};    ///< for `bias`: error that counts = error_rows · (error of the fitted), raw
  Eigen::MatrixXd error_offset{};  ///< rows × effects: each effect there, less the trailing columns' part
};

/// Data of criteria besides the blocks. Blocks are whitened, J = J_raw R⁻¹, so M_raw = Rᵀ M R.
struct CriterionData {
  Eigen::MatrixXd R;                     ///< m × m, upper triangular; see planning/whiten.hpp
  Eigen::VectorXd scale;                 ///< unit of every parameter (its tolerance, …), raw coordinates
  int nuisance = 0;                      ///< leading nuisance columns
  std::vector<TestPoint> test_points{};  ///< for test_pose, test_pose_max
  std::vector<VariantGroup> variants{};  ///< for compound, maximin
  EffectGroup effects{};                 ///< for discriminate, bias

  /// R · diag(scale): M in units of `scale` is Cᵀ M C.
  Eigen::MatrixXd to_scaled() const { return R * scale.asDiagonal(); }
};

}  // namespace posewright
