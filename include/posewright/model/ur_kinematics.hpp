#pragma once

#include <string>
#include <vector>

#include "posewright/model/calibrated_values.hpp"

namespace posewright {

/// A calibrated Universal Robots arm as ur_description takes it (argument kinematics_params /
/// kinematics_parameters_file of its xacro): the origin of each of the six joints in the link before it, x y z in m and
/// roll pitch yaw in rad, R = Rz(yaw) Ry(pitch) Rx(roll). Form: config/ur10/default_kinematics.yaml of
/// ros-industrial/universal_robot.
struct UrKinematics {
  std::string text;
  std::vector<std::string> left_out;  ///< what the file has no place for: "NAME = VALUE UNIT: why"
};

/// @param arm         its URDF made by ur_description: joints shoulder_pan_joint … wrist_3_joint, maybe with a prefix
/// @param convention  whose names the values have
/// @param hash        stands for the controller's own calibration, which the driver compares with the robot's
/// Throws as corrected_urdf(), CannotDo for an arm with other joints, or joints that do not turn about z: frames of
/// ur_description all do.
UrKinematics ur_kinematics(const SerialArmSpec& arm, const SourcePlace& place, VariantSpec::Convention convention,
                           const std::vector<CalibratedValue>& values, const std::string& hash);

}  // namespace posewright
