#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/curvature.hpp"
#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/pipeline/parameters_file.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct CalibrateOptions {
  std::filesystem::path data;
  std::string variant;  ///< empty: as in the file
  Weighting weighting = Weighting::weighted;
  bool prior = false;              ///< also where the problem does not say so
  std::filesystem::path validate;  ///< more data that are not fitted; empty: none
  int hold_back = 0;               ///< every so many-th pose is not fitted; 0: none
};

/// One parameter of a calibrated variant.
struct CalibratedParameter {
  Parameter label;  ///< nominal value: before
  bool estimated = true;
  double value = 0.0, sigma = 0.0;  ///< SI; σ with the factor of Calibration::sigma_factor
  double lower = 0.0, upper = 0.0;  ///< 95 % interval
  std::string why_not{};            ///< not estimated: what the data cannot tell it from
  bool weak = false;                ///< the data tell less than the tolerance
};

/// Residuals of one set of poses with parameters of one kind.
struct ResidualSet {
  std::string poses;       ///< "fitted", "held back"
  std::string parameters;  ///< "nominal", "base and nuisance only", "calibrated"
  std::vector<ResidualSummary> kinds;
};

/// A pose with what is left of its readings.
struct PoseResidual {
  int id = 0;
  bool held_back = false;
  std::vector<double> residuals;  ///< SI, NaN where not read
  double weight = 1.0;            ///< smallest of its targets, robust fits
};

struct Calibration {
  std::string variant;
  Weighting weighting = Weighting::weighted;
  bool prior = false;
  bool automatic = false;  ///< the variant leaves it to the data which parameters are estimated
  int rows = 0, poses = 0, held_back = 0;
  double repeats = 1.0;
  std::vector<Reading> readings;
  std::vector<double> spread;  ///< of every reading within a pose, 1σ of one row; empty without repeats
  Fit fit;
  std::vector<CalibratedParameter> parameters;  ///< interest, nuisance, then those not estimated
  /// Intervals and σ are those of the stated noise times this: above 1 where the residuals are larger than it allows.
  double sigma_factor = 1.0;
  ResidualTests tests;
  TestResult lack_of_fit;  ///< F: residuals of poses against the spread within them
  Curvature curvature;
  std::vector<ResidualSet> residuals;
  std::vector<PoseResidual> pose_residuals;
  std::vector<std::string> columns;  ///< names of what fit.covariance and curvature.parameter count
  std::vector<std::string> notes;
  /// Of the model's whole catalogue, for whoever goes on with the robot.
  std::vector<double> correction;
  std::vector<EstimatedValue> values;  ///< the same as values, under the model's names, with σ where estimated
};

/// Estimates the parameters of a variant from measured data. Columns that the data do not determine stay at their
/// nominal values and are listed. Throws InputError (files) and CannotDo (nothing can be estimated).
Calibration calibrate_problem(const Problem& problem, const CalibrateOptions& options, const Monitor& monitor);

}  // namespace posewright
