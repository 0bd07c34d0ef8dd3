#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/experiment.hpp"

namespace posewright {

/// Errors of one parameter over the draws that were fitted. SI.
struct ParameterErrors {
  double observed = 0.0;  ///< standard deviation of estimate − truth
  double stated = 0.0;    ///< root mean square of the σ that the calibrations state for themselves
  double bias = 0.0;      ///< mean of estimate − truth
  double bias_error = 0.0;
  double coverage = 0.0;           ///< share of the 95 % intervals that hold the truth
  std::optional<double> profiled;  ///< coverage of the intervals by profile, if they were asked for
  /// Draws by (estimate − truth) / the σ that the draw states for itself, as half_sigma_histogram().
  std::vector<int> histogram;
};

struct ExperimentSummary {
  int asked = 0, fitted = 0, not_converged = 0, failed = 0;  ///< finished draws; the rest of `asked` was not run
  std::string first_failure;                                 ///< why the first of the failed ones did
  std::vector<ParameterErrors> parameters;                   ///< in the columns' order; empty without one catalogue
  double sigma_error = 0.0;           ///< Monte Carlo error of an observed σ, relative: 1/√(2 draws)
  double coverage_error = 0.0;        ///< of a coverage that is 95 %
  double chi_square = 0.0;            ///< mean of χ²/freedom
  double chi_square_error = 0.0;      ///< of that mean, where the model is right
  std::optional<double> rejected;     ///< share of draws that the χ² test at 5 % rejects; none: robust, no freedom
  double rejected_error = 0.0;        ///< binomial
  std::optional<double> mean_square;  ///< distance at the places, m²
  double largest = 0.0;               ///< m
  /// Share of the draws, failed ones included, in which each pose gave no reading because of where the true robot
  /// stood.
  std::vector<double> lost{};
  double lost_poses = 0.0;        ///< their sum: poses lost in a draw, in the mean
  std::vector<double> distances;  ///< m, root mean square over the places of each draw that was fitted, ascending
};

/// Reduced in the order of the draws. Throws CannotDo if fewer than two draws were fitted, saying why.
ExperimentSummary summarise(const VirtualExperiment& experiment, const std::vector<VirtualCalibration>& draws);

}  // namespace posewright
