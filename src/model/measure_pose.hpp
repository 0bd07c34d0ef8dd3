#pragma once

#include <memory>
#include <optional>

#include "posewright/model/instrument_view.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

InstrumentView view_of(const PoseMeasurement& pose);

/// Full or partial pose of the tip. Rows: the chosen components of (position of the tip origin in M, rotation as a
/// spatial rotation vector in M): v + ω × p and ω of a twist. Readings pose.{x,…,rz}: the position and the rotation
/// vector of the tip's orientation in M; if rx, ry, rz are not all measured, components of the small rotation from the
/// nominal orientation. No parameters of its own. With photogrammetry the
/// covariance is that of the rigid fit to the points.
///
/// An instrument on the hand reads the pose of M in the tip, X⁻¹ for the tip's pose X = (R, p): rows −Rᵀ v and −Rᵀ ω.
class PoseModel : public MeasurementModel {
 public:
  explicit PoseModel(const MeasurementSpec& spec);

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override;
  bool reads_from_nominal() const override { return turns_ == 1 || turns_ == 2; }
  void difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                  Eigen::VectorXd& out) const override;
  void shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change, Eigen::VectorXd& out) const override;
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override;
  HarmonicNoise harmonic_noise() const override;
  std::optional<Eigen::Matrix<double, 6, 6>> tip_covariance() const override;
  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override;
  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override;

 private:
  Eigen::Isometry3d seen(const Eigen::Isometry3d& X_MeasureTip) const;
  /// Noise of points without direction: at the measurement frame's own axes, turned.
  Eigen::Matrix<double, 6, 6> fitted_covariance(const Eigen::Matrix3d& R) const;

  PoseMeasurement spec_;
  std::unique_ptr<MeasurementModel> points_;  // of photogrammetry
  Eigen::Matrix<double, 6, 6> fitted_ = Eigen::Matrix<double, 6, 6>::Zero();
  double repeats_;
  int turns_ = 0;  // how many of rx, ry, rz are read
};

}  // namespace posewright
