#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Size and length of a smooth effect in the residuals of a fit: theory.md eq. (33), translations alone.
struct SmoothEffect {
  std::string why_not;  ///< why nothing can be said; empty: it can
  double size = 0.0;    ///< τ, 1σ along each axis, m; 0: the residuals show none
  /// 95 % by the profile likelihood; no upper end: infinity.
  double lower = 0.0, upper = 0.0;
  double length = 0.0;       ///< ℓ, rad
  double noise = 1.0;        ///< the readings' own noise beside it, in units of the stated one
  double statistic = 0.0;    ///< likelihood ratio against no effect, 2 ln L
  double probability = 1.0;  ///< that chance alone gives one as large, with the number of lengths tried
  int poses = 0;             ///< that it was estimated from

  bool shown(double level) const { return why_not.empty() && probability < level; }
};

/// By restricted maximum likelihood (Patterson & Thompson 1971, Biometrika 58(3)) on the linearised fit: τ and the
/// readings' noise are free, ℓ is sought over lengths from 15 to 160 deg, or given. τ = 0 is on the edge, so the
/// likelihood ratio is half of χ² of one degree (Self & Liang 1987), times the lengths that were tried. Of more than
/// 150 poses that many, evenly through the list.
/// Effects of instruments are known, and counted as noise beside it.
/// Lengths: the tip's displacement is taken as common to all readings of a pose and smooth between poses.
/// @param own  UnmodelledSize::own
SmoothEffect smooth_effect(const IdentificationModel& model, const VariantColumns& columns,
                           const std::vector<MeasuredPose>& poses, const Fit& fit,
                           std::optional<double> length = std::nullopt, const std::vector<double>& own = {});

}  // namespace posewright
