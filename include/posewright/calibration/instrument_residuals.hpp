#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/residual_statistics.hpp"

namespace posewright {

/// Errors of the other instruments' poses, each left out of the estimate, with an instrument's readings and without
/// any of them. Poses that count with a larger noise than stated judge nothing: they err by more than the estimate.
struct InstrumentHelp {
  double with = 0.0, without = 0.0;  ///< root mean square of whitened residuals; infinite: no estimate predicts them
  double gain = 0.0;                 ///< mean of without² − with², paired by pose, in its own standard errors
  std::vector<std::string> alone{};  ///< columns that the others' readings do not determine

  bool harms() const { return gain < -2.0; }
};

/// Residuals of one instrument of a list.
struct InstrumentResiduals {
  std::string name;
  int poses = 0, readings = 0;
  double chi_square = 0.0;    ///< Σr² of its residuals whitened by the stated noise
  double noise_factor = 1.0;  ///< its readings count with so many times the stated 1σ
  /// What its readings leave of their number, tr(B): B its part of I − H, H = J C Jᵀ the hat matrix of the fit. Σr²
  /// has this mean where model and noise are right.
  double freedom = 0.0;
  TestResult test;                     ///< Σr² against tr(B), both sides; possible if the noise is known
  std::vector<ResidualSummary> kinds;  ///< summarise() of its poses
  std::optional<InstrumentHelp> help;  ///< none: not judged
};

/// One for each instrument that the model has as labels of the coordinate `instrument`; empty for a model without. Σr²
/// is compared with a·χ²(ν), a = tr(B²)/tr(B), ν = tr(B)²/tr(B²), which has its mean and variance (Satterthwaite).
/// Readings that count with a larger noise leave the others' test exact; their own p is then that of noise as stated
/// in a fit that counts more.
/// @param poses   that were fitted
/// @param result  of them; robust and ordinary weights give no test
std::vector<InstrumentResiduals> instrument_residuals(const IdentificationModel& model, const VariantColumns& columns,
                                                      const std::vector<MeasuredPose>& poses, const Fit& result);

}  // namespace posewright
