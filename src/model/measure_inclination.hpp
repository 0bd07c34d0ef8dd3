#pragma once

#include "posewright/model/instrument_view.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Inclinometer on the tip: angle between each of its axes s and the horizontal plane, y = asin(sᵀu) for the upward
/// direction u of the measurement frame. Positions have no effect. No parameters of its own: tool.r* say how it is
/// mounted, and a constant offset is such a turn.
class InclinationModel : public MeasurementModel {
 public:
  explicit InclinationModel(const MeasurementSpec& spec);

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override;
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override;
  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override;
  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override;
  bool sees(const Sighting& sighting) const override;
  std::optional<int> margins() const override { return 2 * rows_; }
  void margins_at(const Sighting& sighting, std::span<double> out) const override;

 private:
  /// Axis of a reading, in M.
  Eigen::Vector3d axis(const Sighting& sighting, Eigen::Index row) const;

  InclinationMeasurement spec_;
  Eigen::Matrix3d R_TipSensor_;
  double repeats_;
};

}  // namespace posewright
