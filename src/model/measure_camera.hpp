#pragma once

#include "posewright/model/instrument_view.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

InstrumentView view_of(const CameraMeasurement& camera);

/// Line of sight (z = 1) whose image is the pixel, by Newton's iteration from where it would be without distortion;
/// what is beyond the reach of the lens's polynomial stays there.
Eigen::Vector3d line_of_sight(const CameraMeasurement& camera, const Eigen::Vector2d& pixel);

/// A camera and a board of known points, one on the tip, the other fixed. Rows: point by point, image coordinates u, v
/// (px). Own parameters: camera.{x,…,rz} and board.{x,…,rz}, displacements of their frames in what carries them (the
/// hand-eye transform and where the fixed one stands), camera.{fx, fy, cx, cy, k1, k2, p1, p2, k3}, and
/// pattern.scale, which multiplies the spacing of the points.
class CameraModel : public MeasurementModel {
 public:
  explicit CameraModel(const MeasurementSpec& spec);

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override;
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override;
  bool motion(const Sighting& sighting, int index, Twist* twist) const override;
  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override;
  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override;
  /// All points in front of the camera and in the image.
  bool sees(const Sighting& sighting) const override;

 private:
  struct Scene;
  Scene scene(const Sighting& sighting) const;

  CameraMeasurement spec_;
  Eigen::Isometry3d X_CarrierCamera_, X_CarrierBoard_;
  std::vector<Eigen::Vector3d> points_;  // board frame
  double repeats_;
};

}  // namespace posewright
