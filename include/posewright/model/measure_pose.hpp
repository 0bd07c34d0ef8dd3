#pragma once

#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Full or partial pose of the tip. Rows: the chosen components of (position of the tip origin in M, rotation as a
/// spatial rotation vector in M): v + ω × p and ω of a twist. No parameters of its own.
class PoseModel : public MeasurementModel {
 public:
  explicit PoseModel(const MeasurementSpec& spec);

  void rows_of_twists(const Eigen::Isometry3d& X_MeasureTip, std::span<const double> correction,
                      const Eigen::Ref<const Twists>& twists, Eigen::Ref<Eigen::MatrixXd> rows) const override;
  /// Throws std::logic_error: there are no own parameters.
  void own_column(const Eigen::Isometry3d& X_MeasureTip, std::span<const double> correction, int index,
                  Eigen::Ref<Eigen::VectorXd> column) const override;
  void covariance(const Eigen::Isometry3d& X_MeasureTip, std::span<const double> correction,
                  Eigen::Ref<Eigen::MatrixXd> covariance) const override;

 private:
  PoseMeasurement spec_;
  double repeats_, repeatability_;
};

}  // namespace posewright
