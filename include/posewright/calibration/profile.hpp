#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Interval of one parameter by its profile: corrections, SI. Infinite: the sum of squares never rises far enough on
/// that side.
struct ProfileInterval {
  double lower = 0.0, upper = 0.0;
};

/// Profile: rise of the sum of squares along one parameter, with all others estimated anew.
///
/// Profile t (Bates & Watts 1988, Nonlinear Regression Analysis and Its Applications, sec. 6.1.2):
/// τ(θ) = sign(θ − θ̂) √(S̃(θ) − S(θ̂)) / s, S̃(θ) the least sum of squares of whitened residuals and prior terms with the
/// parameter at θ. If the noise is known, τ² is compared with the quantile of χ² of one degree of freedom (Venzon &
/// Moolgavkar 1988, Appl. Statist. 37, 87–94); if the residuals told it, with that of F(1, freedom): |τ| with
/// interval_factor() in both cases. For a linear problem τ = (θ − θ̂)/σ, and the interval is the usual one.
/// Covariances of the readings and the size s of the noise stay those of the estimate.
class Profile {
 public:
  /// All are those of the estimate, which has converged. `model` and `poses` must outlive it. Throws CannotDo for
  /// robust weights, whose sum of squares follows no such law.
  Profile(const IdentificationModel& model, const VariantColumns& columns, const std::vector<MeasuredPose>& poses,
          const FitOptions& options, const Fit& fit);
  ~Profile();
  Profile(const Profile&) = delete;
  Profile& operator=(const Profile&) = delete;

  /// τ with the column's correction at `value` (SI), the others estimated from the fit on. None: nothing can be
  /// estimated there (a pose is out of reach, it does not converge), or it was stopped.
  std::optional<double> tau(int column, double value, const Monitor& monitor);
  /// Values at which |τ| first reaches `factor` on either side: steps outwards until the root lies between two of them,
  /// then false position. None: nothing can be estimated beside the fit, or it was stopped.
  std::optional<ProfileInterval> interval(int column, double factor, const Monitor& monitor);
  /// Largest decrease of the sum of squares below the estimate's so far, in units of the noise's variance. Above 0 it
  /// is not the best estimate.
  double better() const;
  /// The corrections of all parameters where that was.
  const std::vector<double>& better_estimate() const;

 private:
  class State;
  class Side;
  std::unique_ptr<State> state_;
};

/// Intervals of several columns, in the order asked for.
struct Profiles {
  std::vector<std::optional<ProfileInterval>> intervals;  ///< none as Profile::interval()
  double better = 0.0;                                    ///< Profile::better(), the most of all
  std::vector<double> better_estimate;
};

/// @param factor   interval_factor() of the fit
/// @param threads  0: all; the result is the same on any number
/// Reports the stage "profiles"; if the monitor stops it, the columns that are left have none. Throws CannotDo as
/// Profile does.
Profiles profile_intervals(const IdentificationModel& model, const VariantColumns& columns,
                           const std::vector<MeasuredPose>& poses, const FitOptions& options, const Fit& fit,
                           const std::vector<int>& wanted, double factor, int threads, const Monitor& monitor);

}  // namespace posewright
