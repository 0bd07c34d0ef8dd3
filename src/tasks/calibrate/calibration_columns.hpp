#pragma once

#include <vector>

#include "given_parameters.hpp"
#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Columns that a calibration estimates, and those of its variant that it holds or drops.
struct ChosenColumns {
  VariantColumns columns;
  std::vector<CalibratedParameter> left_out;  ///< nominal
  GivenParameters given;
};

/// Columns that these poses determine, judged where things stand: at the origin of the flange a target would say
/// nothing of the wrist.
/// @param all     of the variant
/// @param placed  corrections with base and tool alone
ChosenColumns chosen_columns(const IdentificationModel& model, const VariantColumns& all,
                             const std::vector<MeasuredPose>& poses, const std::vector<double>& placed, Prior prior);

}  // namespace posewright
