#pragma once

#include <memory>
#include <span>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Frames that carry bodies: 0 is the measurement frame, the others move with the configuration. Const and callable
/// from several threads.
class BodyFrames {
 public:
  virtual ~BodyFrames() = default;
  int count() const { return count_; }
  /// Frame that carries the tool, and where the tip is in it.
  int tip_frame() const { return count_ - 1; }
  const Eigen::Isometry3d& X_FrameTip() const { return X_FrameTip_; }
  /// Robot's poses in one configuration: a pair of configurations has two.
  int poses_per_configuration() const { return poses_; }

  /// Pose of every frame in the measurement frame for the `pose`-th pose of q.
  virtual void poses(std::span<const double> q, int pose, std::span<Eigen::Isometry3d> X_MeasureFrame) const = 0;
  /// Axis of the joint that moves frame b, in frame b; z for a platform.
  virtual Eigen::Vector3d axis(int b) const = 0;
  /// Per coordinate (of all of a configuration): how far a point of frame b moves at most relative to frame a while
  /// that coordinate changes by one unit.
  /// @param radius       m, largest distance of these points from the origin of b
  /// @param axis_radius  m, the same from the line through the origin along axis(b); not read if b < a
  virtual Eigen::VectorXd travel(int pose, int a, int b, double radius, double axis_radius) const = 0;
  /// After which change of a coordinate all frames are where they were, rad; 0: none.
  virtual double period(std::size_t) const { return 0.0; }
  /// Frames from which on a parameter of that name acts: k means k, k + 1, …; 0: the base, count(): none.
  virtual int acts_from(const std::string& parameter) const = 0;

 protected:
  int count_ = 1, poses_ = 1;
  Eigen::Isometry3d X_FrameTip_ = Eigen::Isometry3d::Identity();
};

/// @param model  must outlive the frames. Throws CannotDo for a robot whose bodies cannot be placed.
std::unique_ptr<BodyFrames> make_body_frames(const Problem& problem, const IdentificationModel& model);

}  // namespace posewright
