#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/study.hpp"

namespace posewright {

/// Whitened residuals of a fit, which show how large an effect is.
struct FittedResiduals {
  double squares = 0.0;  ///< their sum of squares, in units of the stated noise
  double freedom = 0.0;  ///< its expectation without an effect
};

/// The one place where an error is predicted for people. Least squares V Jᵀ r of readings r = J θ + F u + ε miss a
/// place with the parameters' Jacobian A and the effect's B by A V Jᵀ(F u + ε) − B u (theory.md eq. (35)); of all
/// places together the best rigid base and tool are taken out (eq. (68)). Size of the effect: of the variant if it
/// states one; with residuals, from these by moments (eq. (69)); of an earlier calibration; else of all sizes that
/// robots have, over UnmodelledSize::assumed_length. At the variant's test poses; without any at 200 of the candidates.
class ErrorsToExpect {
 public:
  /// @param measured  poses with their readings; what was not read says nothing
  /// @param more      that are to be measured after these, with all readings
  ErrorsToExpect(const Configurations& candidates, const Variant& variant, const std::vector<MeasuredPose>& measured,
                 const Configurations& more, int threads);
  ~ErrorsToExpect();

  /// The size of the effect is that which the residuals of the measured poses show, if these are enough to show one.
  /// @param covariance  of the estimate from the measured poses, with the stated noise
  void take_size_of(const FittedResiduals& residuals, const Eigen::MatrixXd& covariance);

  /// After the first 0, 1, … poses.
  /// @param covariances  of the estimates from these, with the stated noise; an empty matrix: they give none
  /// @return none where there is no estimate, the readings tell of no single tip, or no estimated parameter moves it
  std::vector<std::optional<ExpectedError>> after_each(const std::vector<Eigen::MatrixXd>& covariances) const;
  /// After all poses.
  std::optional<ExpectedError> after_all(const Eigen::MatrixXd& covariance) const;

 private:
  class Places;
  std::unique_ptr<Places> places_;
};

/// After these poses, with all their readings.
std::optional<ExpectedError> expected_error(const Configurations& candidates, const Variant& variant,
                                            const Configurations& poses, const Eigen::MatrixXd& covariance,
                                            int threads);

}  // namespace posewright
