#pragma once

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Random displacement of the tip at every visit that nobody stated, as the readings show it.
struct VisitErrors {
  double translation = 0.0;    ///< 1σ, m, each axis; 0 if it is stated
  double rotation = 0.0;       ///< 1σ, rad, about each axis through the tip; 0 if it is stated
  double noise = 1.0;          ///< factor of the stated 1σ beside them, at least 1
  double probability = 1.0;    ///< that chance alone gives as large a gain of the likelihood
  double contradiction = 1.0;  ///< that chance makes the visits err so much more than is stated; 1: nothing is stated
  double together[2] = {0.0, 0.0};  ///< all of displacement and rotation, as if nothing were stated

  bool shown() const { return probability < seldom; }
  bool contradicts() const { return contradiction < seldom; }

 private:
  static constexpr double seldom = 0.01;
};

/// Restricted maximum likelihood (Patterson & Thompson 1971) of three variances at a fit: a factor of the stated
/// covariance, and the tip's displacement and rotation, which all readings of a pose have in common. A stated size is
/// knowledge and stays as it is. Nothing is found where every visit has as many readings as its displacement has
/// directions: only further ones tell it from noise.
/// @param model  with the stated noise and repeatability
VisitErrors visit_errors(const IdentificationModel& model, const Repeatability& stated, const VariantColumns& columns,
                         const std::vector<MeasuredPose>& poses, const Fit& fit, Prior prior);

}  // namespace posewright
