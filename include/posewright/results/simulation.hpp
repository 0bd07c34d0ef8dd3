#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "posewright/blocks/parameter.hpp"
#include "posewright/calibration/curvature.hpp"
#include "posewright/calibration/experiment_summary.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/problem/units.hpp"

namespace posewright {

/// Noise of the robot that is measured, where it differs from the problem's: the result of a calibration that expects
/// one kind of noise makes of another. 1σ; none: as the problem says.
struct TruthNoise {
  std::optional<double> repeatability;  ///< m: the tip stands off, common to all readings of a visit
  std::optional<double> independent;    ///< m: every target stands off on its own
  std::optional<Measured> joints;       ///< rad or m: error of the joint or actuator readings
  bool differs() const { return repeatability || independent || joints; }
};

struct SimulateOptions {
  std::string variant;  ///< that is calibrated; empty: as in the file
  std::string truth;    ///< whose model gives the readings; empty: the same variant
  TruthNoise truth_noise;
  bool truth_nominal = false;  ///< of the truth only the nominal values differ: parameters of `variant` are drawn
  int validation = 50;         ///< random places to check if the problem has no test poses
  /// Configurations for choosing the identifiable columns of an `auto` variant; none: the file's.
  std::optional<int> candidates;
  ExperimentOptions experiment;
};

struct SimulatedParameter {
  Parameter label;
  double predicted = 0.0;                 ///< 1σ by (JᵀJ)⁻¹ at the nominal parameters, SI
  std::optional<ParameterErrors> errors;  ///< none if the truth has another catalogue of parameters
};

/// Error of the calibrated robot, m.
struct SimulatedAccuracy {
  bool test_poses = false;  ///< the problem's; else random validation poses
  int places = 0;
  double predicted = 0.0;  ///< ρ0
  double observed = 0.0;   ///< root mean square over draws and places
  double largest = 0.0;
};

/// A pose that some true robots cannot take, or cannot be read at.
struct LostPose {
  int id = 0;
  double share = 0.0;  ///< of the draws
};

struct Simulation {
  std::string variant, truth, plan;
  int poses = 0;
  int readings = 0;  ///< if no target is missing
  int hidden = 0;    ///< readings of targets that the cell hides
  ExperimentSummary summary;
  std::vector<SimulatedParameter> parameters;
  std::optional<SimulatedAccuracy> accuracy;  ///< none for a robot without a tip, or where nothing moves it
  std::vector<LostPose> lost{};               ///< most often lost first
  std::string lost_because{};                 ///< reasons for missing readings
  Curvature curvature;                        ///< at the nominal parameters
  bool confirmed = false;                     ///< σ and intervals are as predicted
  std::vector<std::string> verdict;           ///< in words, and why
  bool interrupted = false;
  std::vector<std::string> notes;
  std::string first_readings;  ///< of draw 0, as `calibrate` reads them
};

/// Text for the terminal: every parameter predicted and observed, accuracy, χ², the verdict.
std::string simulation_text(const Simulation& simulation, const SimulateOptions& options);

/// Complete JSON: schema posewright/simulation/1.
nlohmann::ordered_json simulation_json(const Problem& problem, const SimulateOptions& options,
                                       const Simulation& simulation);

}  // namespace posewright
