#pragma once

#include <string>
#include <vector>

#include "posewright/model/calibrated_values.hpp"

namespace posewright {

/// A URDF that has a calibrated robot's kinematics.
struct CorrectedUrdf {
  std::string text;
  std::vector<std::string> left_out;  ///< corrections that a URDF cannot hold: "NAME = VALUE UNIT: why"
};

/// The arm's URDF file with the <origin> of joints between base and tip changed and not one byte else: displacements of
/// joint frames, joint offsets (those of mimic joints follow their master) and, where a fixed joint ends in the tip,
/// the tool. Readings keep their meaning and limits theirs. An <origin> is put in where a joint has none.
/// @param place       where the problem file names the robot
/// @param convention  whose names the values have
/// Throws as read_urdf_chain and chain_correction, InputError too for a joint whose name is not well-formed text.
CorrectedUrdf corrected_urdf(const SerialArmSpec& arm, const SourcePlace& place, VariantSpec::Convention convention,
                             const std::vector<CalibratedValue>& values);

/// Variant for the xacro file of the URDF: comments, macros and all else stay, an origin that was
/// an expression becomes numbers. Lengths and angles that other lines compute from the same properties stay as they
/// are. Throws as corrected_urdf(); CannotDo for a joint that this file has not exactly once (an included file has it,
/// a macro makes several of it) or whose origin comes from a macro; InputError for a robot that is no xacro file.
CorrectedUrdf corrected_xacro(const SerialArmSpec& arm, const SourcePlace& place, VariantSpec::Convention convention,
                              const std::vector<CalibratedValue>& values);

}  // namespace posewright
