#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/calibration/instrument_residuals.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Cross-validation: estimates from some of the poses predict the others.
struct LeaveOut {
  int groups = 0;          ///< 0: not judged, `why_not` says why
  double estimated = 0.0;  ///< root mean square of whitened residuals of poses left out, all columns estimated
  double placed = 0.0;     ///< the same with only those estimated that say where things stand
  /// Mean gain of the estimate over all poses left out, paired, in its own standard errors: above 2 it is not an
  /// accident.
  double gain = 0.0;
  /// posewright::gain_in_range() of the estimate from all poses; none: not judged.
  std::optional<double> gain_in_range{};
  std::vector<double> squares;  ///< mean square of every pose left out, by the estimate; in the order they were
  std::string why_not;          ///< not judged, or: why the estimate cannot predict (infinite)

  /// The estimate predicts better than knowing where things stand does; worse: both beyond chance.
  bool gains() const { return groups > 0 && gain > 2.0; }
  bool gains_in_range() const { return !gain_in_range || *gain_in_range > 2.0; }
  bool worse() const { return groups > 0 && !(gain >= -2.0); }
};

/// Leaves out one pose after the other (above 30 poses one of ten groups: every tenth pose), estimates from the rest
/// and predicts the left-out readings, once with all columns and once with the placing columns alone
/// (placing_columns()). Judged by the lengths among the readings if there are any. A predicted variance cannot judge
/// this: a prior always lowers it, and the noise may not be as stated. With robust weights medians take the place of
/// means, and the gain is that of a sign test.
/// @param start  corrections of all parameters: things placed, nothing else estimated
/// @param whole  the estimate from all poses
LeaveOut leave_out(const IdentificationModel& model, const VariantColumns& columns,
                   const std::vector<MeasuredPose>& poses, const FitOptions& options, const std::vector<double>& start,
                   const Fit& whole, const Monitor& monitor);

/// Leaves each instrument of a list out, estimates from the rest of each group of leave_out() and predicts the other
/// instruments' poses of that group, for InstrumentResiduals::help. It stays none where no pose of another instrument
/// is left, or where the search was stopped early.
/// @param whole   the estimate from all poses
/// @param judged  of all poses
/// @param instruments  instrument_residuals() of `whole`
void judge_help(const IdentificationModel& model, const VariantColumns& columns, const std::vector<MeasuredPose>& poses,
                const FitOptions& options, const Fit& whole, const LeaveOut& judged, const Monitor& monitor,
                std::vector<InstrumentResiduals>& instruments);

/// The combination of the columns that the readings alone tell least of, in units of tolerance: "0.71 a2.offset − 0.70
/// base.ry are told apart to 531 tolerances only". Empty if all are told better than three tolerances.
std::string weakest_combination(const Fit& result, const VariantColumns& columns);

}  // namespace posewright
