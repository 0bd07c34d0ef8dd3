#pragma once

#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/model/tip_model.hpp"

namespace posewright {

/// One factor of a chain written as elementary motions: a rotation about or a translation along x, y or z.
struct ElementaryMotion {
  bool rotation = false;
  int axis = 0;          ///< 0 x, 1 y, 2 z
  double nominal = 0.0;  ///< rad or m
  int coordinate = -1;   ///< added to it, with the sign +1; −1: none
  std::string name;      ///< of its parameter; empty: fixed
};

/// A serial chain in Denavit–Hartenberg parameters: X_MeasureTip = base · Π motions · tool.
struct DhDescription {
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();  ///< X_MeasureBase, its z along the first joint's axis
  std::vector<ElementaryMotion> motions;
  Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();
  std::vector<Coordinate> coordinates;
  std::vector<double> encoder_noise;
};

enum class DhConvention { distal, proximal };

/// Denavit–Hartenberg parameters of a chain from where its axes are at zero position. Joint by joint
///   distal (Denavit & Hartenberg 1955):  Rz(θ) Tz(d) Tx(a) Rx(α) with the joint first,
///   proximal ("modified", Craig):        Rx(α) Tx(a) Rz(θ) Tz(d) with the joint last;
/// the product is the same, what differs is which joint a and α are named after. Where an axis is parallel to the next,
/// d is replaced by a rotation β about y (Hayati 1983): Rz(θ) Tx(a) Rx(α) Ry(β), else d would be undetermined and small
/// misalignments would make it jump. Throws CannotDo for a chain with mimic joints.
DhDescription denavit_hartenberg(const ChainDescription& chain, DhConvention convention);

/// Parameters: base.{x,…,rz}; JOINT.{theta, d, a, alpha, beta} as there are; tool.{x,…,rz}.
class DhChain : public TipModel {
 public:
  explicit DhChain(DhDescription chain);

  /// Degree 1 in each joint.
  HarmonicColumns harmonic_columns(std::span<const int> selected, const Point& at) const override;

  bool linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip, Twists& twists,
                 Twists* reading_twists) const override;

  bool pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                 std::span<double> gradient) const override;

  const DhDescription& description() const { return chain_; }

 private:
  struct State;
  /// Tip's pose and every twist at one configuration.
  Eigen::Isometry3d run(const Point& at, State& state) const;

  DhDescription chain_;
  int tool_ = 0;  ///< index of tool.x
};

}  // namespace posewright
