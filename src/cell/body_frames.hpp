#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Frames that carry bodies: 0 is the measurement frame, of a robot with several tips its root, the others move with
/// the configuration. Const and callable from several threads.
class BodyFrames {
 public:
  virtual ~BodyFrames() = default;
  int count() const { return count_; }
  struct Tip {
    int frame = 0;
    Eigen::Isometry3d X_FrameTip = Eigen::Isometry3d::Identity();
  };
  /// Frame that carries a tool, and where the tip is in it.
  /// @param name  of one of several tips; else of no account
  virtual Tip tip(const std::string& name) const {
    (void)name;
    return {count_ - 1, X_FrameTip_};
  }
  /// Measurement frame.
  /// @param in  one of several tips; empty: the base
  virtual Tip measurement_frame(const std::string& in) const {
    (void)in;
    return {};
  }
  /// Frames on the way to a tip, from the first that moves on.
  struct Branch {
    std::vector<int> frames;
    Tip tip;
  };
  virtual std::vector<Branch> branches() const;
  /// Robot's poses in one configuration: a pair of configurations has two.
  int poses_per_configuration() const { return poses_; }

  /// Pose of every frame in the measurement frame for the `pose`-th pose of q.
  virtual void poses(std::span<const double> q, int pose, std::span<Eigen::Isometry3d> X_MeasureFrame) const = 0;
  /// Axis of the joint that moves frame b, in frame b; z for a platform.
  virtual Eigen::Vector3d axis(int b) const = 0;
  /// Per coordinate (of all of a configuration): how far points of frame b, or what is between them, move at most
  /// relative to frame a while that coordinate changes by one unit, m; infinite where no bound is known.
  /// @param points  m, in frame b
  virtual Eigen::VectorXd travel(int pose, int a, int b, std::span<const Eigen::Vector3d> points) const = 0;
  /// How a frame moves relative to another one along a straight motion.
  struct Rate {
    Eigen::Vector3d v = Eigen::Vector3d::Zero(), omega = Eigen::Vector3d::Zero();  ///< p moves by v + omega × p
    double turn = 0.0;        ///< rad: angles of all joints between the two
    double least_turn = 0.0;  ///< rad: the smallest of them; 0 with a prismatic joint
  };
  /// Rate of frame b relative to frame a, axes of the measurement frame, while a configuration changes by `change`.
  /// Nothing where only travel() is known.
  /// @param X  all frames at the state in question
  virtual std::optional<Rate> rate(int pose, int a, int b, std::span<const double> change,
                                   std::span<const Eigen::Isometry3d> X) const {
    (void)pose, (void)a, (void)b, (void)change, (void)X;
    return std::nullopt;
  }
  /// After which change of a coordinate all frames are where they were, rad; 0: none.
  virtual double period(std::size_t) const { return 0.0; }
  /// Frames from which on a parameter of that name acts: k means k and what it carries; 0: the base, count(): none.
  virtual int acts_from(const std::string& parameter) const = 0;
  /// True if a parameter that acts from there moves frame b, or what stands in it, off frame a.
  /// @param stands  a is what stands in the measurement frame: a base that is elsewhere moves off it
  virtual bool acts_between(int from, int a, int b, bool stands) const {
    return from > (stands && a == 0 ? -1 : std::min(a, b)) && from <= std::max(a, b);
  }
  /// Spatial twist of frame 0's axes by a parameter that acts from there, per unit; nothing where the robot's own model
  /// has it.
  virtual std::optional<Eigen::Matrix<double, 6, 1>> twist(const std::string& parameter, std::span<const double> q,
                                                           std::span<const Eigen::Isometry3d> X) const {
    (void)parameter, (void)q, (void)X;
    return std::nullopt;
  }

 protected:
  int count_ = 1, poses_ = 1;
  Eigen::Isometry3d X_FrameTip_ = Eigen::Isometry3d::Identity();
};

/// @param model  must outlive the frames. Throws CannotDo for a robot whose bodies cannot be placed.
std::unique_ptr<BodyFrames> make_body_frames(const Problem& problem, const IdentificationModel& model);

}  // namespace posewright
