#pragma once

#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Positions of targets fixed to the tip. Rows: target by target, the chosen components of its position in M. A twist
/// (v, ω) moves the point p with v + ω × p. Own parameters: target.NAME.x, y, z in the tip frame (m).
class PointsModel : public MeasurementModel {
 public:
  explicit PointsModel(const MeasurementSpec& spec);

  void rows_of_twists(const Eigen::Isometry3d& X_MeasureTip, std::span<const double> correction,
                      const Eigen::Ref<const Twists>& twists, Eigen::Ref<Eigen::MatrixXd> rows) const override;
  void own_column(const Eigen::Isometry3d& X_MeasureTip, std::span<const double> correction, int index,
                  Eigen::Ref<Eigen::VectorXd> column) const override;
  void covariance(const Eigen::Isometry3d& X_MeasureTip, std::span<const double> correction,
                  Eigen::Ref<Eigen::MatrixXd> covariance) const override;

 private:
  PointsMeasurement spec_;
  double repeats_, repeatability_;
};

}  // namespace posewright
