#pragma once

#include "posewright/model/instrument_view.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

InstrumentView view_of(const PlaneMeasurement& plane);

/// Distance of one probe on the tip from a plane in the measurement frame, along the normal n: d = nᵀ(p − o) − offset.
/// A touch reads zero. Own parameters: target.probe.{x,y,z} (tip frame), plane.offset (m), plane.u and plane.v (tilts
/// of the normal: n ∝ n₀ + u e_u + v e_v; e_u is along the projection of the axis of the measurement frame that is most
/// across n₀, the first of equal ones; e_v = n₀ × e_u).
class PlaneModel : public MeasurementModel {
 public:
  explicit PlaneModel(const MeasurementSpec& spec);

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override;
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override;
  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override;
  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override;
  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override;
  bool sees(const Sighting& sighting) const override;
  std::optional<int> margins() const override { return 3; }
  void margins_at(const Sighting& sighting, std::span<double> out) const override;

 private:
  struct Touch {
    Eigen::Vector3d probe;   ///< in M
    Eigen::Vector3d from;    ///< from the plane's point to the probe
    Eigen::Vector3d tilted;  ///< n₀ + u e_u + v e_v
    Eigen::Vector3d normal;  ///< of length 1
    double distance = 0;     ///< reading, m
    double beside = 0;       ///< distance from the plane's point in the plane, m
  };
  Touch touch(const Sighting& sighting) const;

  PlaneMeasurement spec_;
  Eigen::Matrix<double, 3, 2> in_plane_;  ///< e_u, e_v
  double repeats_;
};

}  // namespace posewright
