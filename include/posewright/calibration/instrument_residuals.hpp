#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/residual_statistics.hpp"

namespace posewright {

/// Residuals of one instrument of a list.
struct InstrumentResiduals {
  std::string name;
  int poses = 0, readings = 0;
  double chi_square = 0.0;  ///< Σr² of its whitened residuals
  /// What its readings leave of their number, tr(B): B its part of I − H, H = J C Jᵀ the hat matrix of the fit. Σr²
  /// has this mean where model and noise are right.
  double freedom = 0.0;
  TestResult test;                     ///< Σr² against tr(B), both sides; possible if the noise is known
  std::vector<ResidualSummary> kinds;  ///< summarise() of its poses
};

/// One for each instrument that the model has as labels of the coordinate `instrument`; empty for a model without. Σr²
/// is compared with a·χ²(ν), a = tr(B²)/tr(B), ν = tr(B)²/tr(B²), which has its mean and variance (Satterthwaite).
/// @param poses   that were fitted
/// @param result  of them; robust and ordinary weights give no test
std::vector<InstrumentResiduals> instrument_residuals(const IdentificationModel& model, const VariantColumns& columns,
                                                      const std::vector<MeasuredPose>& poses, const Fit& result);

}  // namespace posewright
