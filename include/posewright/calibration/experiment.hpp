#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct ExperimentOptions {
  int draws = 1000;
  bool exact = false;          ///< true parameters are the nominal ones
  double missing = 0.0;        ///< share of the targets that are not read, [0, 1)
  double outliers = 0.0;       ///< share of the targets with a gross error, [0, 1]
  double outlier_size = 20.0;  ///< of a gross error, in σ of its target along a random direction
  FitOptions fit;
  bool profile = false;  ///< judge intervals by profiles, too: one more fit for every parameter
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0 = all
};

/// The robot that is measured: it may be another model than the one that is calibrated.
struct VirtualRobot {
  const IdentificationModel* model = nullptr;
  VariantColumns drawn;  ///< parameters that differ from nominal, one tolerance (1σ) each, normal
  std::vector<std::vector<double>> configurations;  ///< of this model, pose by pose: the same actuators
  /// Poses that its instrument can read where the robot is nominal: there it is asked whether it can at the true one.
  std::vector<char> asked{};
};

/// Validation poses of the calibrated robot. Instruments of both models read the tip's pose.
struct CheckPlaces {
  const IdentificationModel *fitted = nullptr, *truth = nullptr;
  /// Per parameter of these models: its index in the calibrated (in the true) one; −1: stays nominal, as what only
  /// the measurement knows (base, targets) does.
  std::vector<int> fitted_from, truth_from;
  std::vector<std::vector<double>> fitted_q, truth_q;  ///< place by place: the same actuators
  std::vector<double> weights;                         ///< one a place
  Eigen::Vector3d point = Eigen::Vector3d::Zero();     ///< m, tip frame: whose position counts
};

/// Measure, calibrate, compare with the truth, `options.draws` times.
struct VirtualExperiment {
  const IdentificationModel* model = nullptr;  ///< that is calibrated
  VariantColumns columns;
  std::vector<MeasuredPose> poses;  ///< y: NaN for what can never be read there, else any number
  VirtualRobot truth;
  bool one_catalogue = true;  ///< parameters of both models mean the same
  std::optional<CheckPlaces> places;
  ExperimentOptions options;
};

/// Result of one draw.
struct VirtualCalibration {
  enum class End { not_run, fitted, not_converged, failed };
  End end = End::not_run;
  std::string why;        ///< it failed
  Eigen::VectorXd error;  ///< estimate − truth of every column, SI; empty without one catalogue
  Eigen::VectorXd sigma;  ///< 1σ that the calibration states for itself
  double interval = 0.0;  ///< half the 95 % interval in these σ: of the normal, or of Student's t (σ from residuals)
  Eigen::VectorXd tau;    ///< profile t at the truth (Profile::tau()), NaN: none there; empty: not asked for
  double chi_square = 0.0;
  int freedom = 0;
  double mean_square = 0.0, largest = 0.0;  ///< distance at the places: weighted mean square (m²), largest (m)
  std::vector<char> lost;                   ///< poses that the true robot or its instrument did not give

  static auto fields(auto& own) {
    return std::tie(own.end, own.why, own.error, own.sigma, own.interval, own.tau, own.chi_square, own.freedom,
                    own.mean_square, own.largest, own.lost);
  }
};

/// True parameters (correction of every parameter of the true model) and readings of one draw, poses without any
/// reading left out. Depends on the seed and `draw` alone; noise is the same with and without --exact, gross errors and
/// missing targets. A pose that the true robot cannot take, or at which its instrument cannot read it, gives nothing.
/// @param lost  1 for each of these poses; may be null
std::vector<MeasuredPose> draw_readings(const VirtualExperiment& experiment, int draw, std::vector<double>& truth,
                                        std::vector<char>* lost = nullptr);

/// All draws, in parallel; the same for any number of threads. Those that the monitor stopped are `not_run`.
std::vector<VirtualCalibration> run_experiment(const VirtualExperiment& experiment, const Monitor& monitor);

}  // namespace posewright
