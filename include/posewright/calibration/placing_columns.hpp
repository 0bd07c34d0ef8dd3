#pragma once

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Columns that place things, without parameters of the robot: base.*, tool.*, target.*, station.*,
/// anchor.*, camera.* and board.* displacements (Parameter::places), and whatever the variant calls nuisance.
VariantColumns placing_columns(const VariantColumns& columns);

/// The columns that these poses and the tolerances that count determine, by identifiability() at the corrections `at`.
/// @param dependencies  of left-out parameters; null: not needed
/// @param threshold     IdentifiabilityOptions::threshold; 0: its default
VariantColumns determined(const IdentificationModel& model, const VariantColumns& columns,
                          const std::vector<MeasuredPose>& poses, const std::vector<double>& at, Prior prior,
                          std::vector<Dependency>* dependencies = nullptr, double threshold = 0.0);

/// Fits the placing columns alone. Nobody knows how an instrument's axes lie to a robot's base before the first fit:
/// where the nominal base leaves residuals that no error of a robot explains, the 24 rotations of a cube are tried as
/// its orientation and the best is kept.
/// @return corrections of all parameters; zero if there are no such columns
std::vector<double> placed(const IdentificationModel& model, const VariantColumns& columns,
                           const std::vector<MeasuredPose>& poses, const FitOptions& options);

/// Variant for what moved before another campaign, all else as in `from`.
/// @param moved  its columns, those of its base first if that moved
std::vector<double> placed_moved(const IdentificationModel& model, const VariantColumns& moved,
                                 const std::vector<MeasuredPose>& poses, const FitOptions& options,
                                 const std::vector<double>& from);

/// Equivalent orientations by rx and rz from −180 to 180 deg, ry from −90 to 90 deg: an estimate from another side
/// would state them by other angles.
/// @param columns     of which every frame with three free angles counts
/// @param correction  of all parameters
/// @return whether an angle changed
bool take_canonical_angles(const IdentificationModel& model, const VariantColumns& columns,
                           std::vector<double>& correction);

}  // namespace posewright
