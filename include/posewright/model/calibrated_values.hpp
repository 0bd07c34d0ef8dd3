#pragma once

#include <span>
#include <string>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// One parameter of a calibrated robot under the model's name, SI.
struct CalibratedValue {
  std::string name;
  std::string unit;
  double nominal = 0.0;  ///< the robot's own, as URDF or problem file give it without a variant's `nominal`
  double value = 0.0;

  double correction() const { return value - nominal; }
};

/// Every parameter of a variant's model at its nominal values in force plus `correction`.
/// @param model       of this problem and variant
/// @param correction  ξ − nominal for every parameter, or empty for all zero
std::vector<CalibratedValue> calibrated_values(const ProblemVariant& variant, const IdentificationModel& model,
                                               std::span<const double> correction);

/// Displacement behind a frame of a chain by corrections, with their parameters.
struct FrameCorrection {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  std::vector<CalibratedValue> by;  ///< those that are not nominal; empty: X is exactly the identity
};

/// A calibrated serial arm written as corrections of the frames of its nominal chain. With them its tip is at
///   X_MeasureBase · base · Π_k [X_ParentJoint,k · joints_k · Motion_k(multiplier q + mimic offset)] · X_LastTip · tip,
/// with the factor X_ParentJoint,k · Motion_k · joints_k⁻¹ of a joint that is passed backward: in the URDF, joints_k
/// stands behind the origin of any joint.
struct ChainCorrection {
  FrameCorrection base, tip;
  std::vector<FrameCorrection> joints;    ///< as many as the chain has
  std::vector<CalibratedValue> left_out;  ///< not nominal, and no displacement of a frame: gears, springs, targets
};

/// @param convention  whose names the values have: the joint frames' or Denavit–Hartenberg parameters
/// Throws CannotDo for Denavit–Hartenberg parameters of a chain with mimic joints.
ChainCorrection chain_correction(const ChainDescription& chain, VariantSpec::Convention convention,
                                 const std::vector<CalibratedValue>& values);

/// The chain with base, joints and tip corrected.
ChainDescription corrected_chain(ChainDescription chain, const ChainCorrection& correction);

/// "joint_a2.gear = 0.0012: why", as in lists of corrections that a file cannot hold.
std::string left_out_text(const CalibratedValue& value, const std::string& why);

}  // namespace posewright
