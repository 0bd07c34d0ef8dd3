#pragma once

#include "displacement.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Positions of the pins of a gravity compensator: markers on the fixed pin P0 and on the link's pin P1 are measured
/// over the joint's range. In a frame with the joint's axis as z through its origin P2 (theory.md eq. (12)):
///   P0 = −(ax, ay, 0),  P1 = L (sin(q2 + offset), cos(q2 + offset), 0).
/// Configuration: q2 (rad). Rows: P0 and P1 in the measurement frame. Parameters: L, ax, ay (m), q2.offset (rad),
/// base.{x,…,rz} (the axis in the measurement frame).
class CompensatorGeometry : public IdentificationModel {
 public:
  /// Throws CannotDo unless the instrument measures two points called P0 and P1 from one place.
  CompensatorGeometry(const CompensatorGeometrySpec& spec, const MeasurementSpec& measurement);

 private:
  bool do_read(const Point& at, Eigen::VectorXd& y) const override;
  bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const override;
  Eigen::Isometry3d do_tool_pose(const Point& at) const override;

  /// The axis' frame, where the pins are in M, and the crank's direction in the frame.
  struct Pins {
    Frame<double> frame;
    DisplacementAxes base;
    Eigen::Vector3d along, across, P0, P1;
    double L;
  };
  Pins pins(const Point& at) const;

  CompensatorGeometrySpec spec_;
  PointNoise noise_;
  double repeats_, repeatability_;
};

}  // namespace posewright
