#pragma once

#include "posewright/model/instrument_view.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"
#include "station_frames.hpp"

namespace posewright {

InstrumentView view_of(const PointsMeasurement& points);

/// Positions of targets fixed to the tip. Rows: target by target, the chosen components of its position in the frame of
/// the station that looks (the measurement frame if there are no stations). Own parameters: target.NAME.{x,y,z} in
/// the tip frame (m), station.NAME.{x,…,rz}.
class PointsModel : public MeasurementModel {
 public:
  explicit PointsModel(const MeasurementSpec& spec);

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override;
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override;
  bool motion(const Sighting& sighting, int index, Twist* twist) const override;
  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override;
  HarmonicNoise harmonic_noise() const override;
  std::optional<Eigen::Matrix<double, 6, 6>> tip_covariance() const override;
  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override;
  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override;

 private:
  std::span<const double> station_part(std::span<const double> correction) const;
  Eigen::Vector3d target(const Sighting& sighting, std::size_t index) const;

  PointsMeasurement spec_;
  Stations places_;
  double repeats_;
};

}  // namespace posewright
