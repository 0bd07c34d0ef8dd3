#pragma once

#include "displacement.hpp"
#include "posewright/model/instrument_view.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

InstrumentView view_of(const LineMeasurement& line);

/// Laser profiler on the tip that sees a straight edge or a wire: x and z of the point where the line meets the plane
/// y = 0 of the sensor's frame. Own parameters: sensor.{x, …, rz}, which stand for the tool; line.u and line.v, offsets
/// of the line across its direction d (m), line.tilt_u and line.tilt_v, its tilts about its point: d ∝ d₀ + t_u e_u +
/// t_v e_v. Axes e_u and e_v as those of a plane with the normal d₀ (PlaneModel).
class LineModel : public MeasurementModel {
 public:
  explicit LineModel(const MeasurementSpec& spec);

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override;
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override;
  bool motion(const Sighting& sighting, int index, Twist* twist) const override;
  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override;
  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override;
  bool sees(const Sighting& sighting) const override;
  std::optional<int> margins() const override { return 5; }
  void margins_at(const Sighting& sighting, std::span<double> out) const override;

 private:
  struct Crossing {
    DisplacementAxes sensor;           ///< in M
    Eigen::Vector3d place;             ///< where the line meets the sensor's plane, in M, m
    double along = 0;                  ///< of that place, from the line's point, in units of the direction's length
    Eigen::Vector2d reading;           ///< x and z in the sensor's frame, m
    Eigen::Matrix<double, 2, 3> rows;  ///< by a small motion of the line's point there, M
    double across = 0;                 ///< sine of the angle between line and sensor's plane
  };
  Crossing crossing(const Sighting& sighting) const;

  LineMeasurement spec_;
  Eigen::Isometry3d X_TipSensor_;
  Eigen::Matrix<double, 3, 2> across_;  ///< e_u, e_v
  double repeats_;
};

}  // namespace posewright
