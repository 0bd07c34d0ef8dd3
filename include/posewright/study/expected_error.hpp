#pragma once

#include <optional>

#include "posewright/outputs/plan.hpp"
#include "posewright/study/study.hpp"

namespace posewright {

/// Whitened residuals of a fit, which show how large an effect is.
struct FittedResiduals {
  double squares = 0.0;  ///< their sum of squares, in units of the stated noise
  double freedom = 0.0;  ///< its expectation without an effect
  double share = 1.0;    ///< of the readings that were read
};

/// The one place where an error is predicted for people. Least squares V Jᵀ r of readings r = J θ + F u + ε miss a
/// place with the parameters' Jacobian A and the effect's B by A V Jᵀ(F u + ε) − B u (theory.md eq. (35)); of all
/// places together the best rigid base and tool are taken out (eq. (68)). Size of the effect: of the variant if it
/// states one; with residuals, from these by moments (eq. (69)); of an earlier calibration; else of all sizes that
/// robots have, over UnmodelledSize::assumed_length. At the variant's test poses; without any at 200 of the candidates.
/// @param poses       all that are measured
/// @param covariance  of the estimate from these, with the stated noise
/// @return none where the readings tell of no single tip, or no estimated parameter moves it
std::optional<ExpectedError> expected_error(const Configurations& candidates, const Variant& variant,
                                            const Configurations& poses, const Eigen::MatrixXd& covariance, int threads,
                                            const std::optional<FittedResiduals>& residuals = std::nullopt);

}  // namespace posewright
