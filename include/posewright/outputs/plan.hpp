#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "posewright/blocks/parameter.hpp"
#include "posewright/criterion/observability_indices.hpp"

namespace posewright {

/// A named value with its unit: one entry of a configuration or an actuator.
struct NamedValue {
  std::string name;
  std::string unit;
  double value = 0.0;
};

struct PlannedPose {
  int id = 0;                                  ///< 1, 2, … in measuring order
  int candidate = 0;                           ///< zero-based index in the candidate set
  std::vector<NamedValue> configuration;       ///< empty for a plan made from bare blocks
  std::vector<NamedValue> actuators;           ///< of a parallel robot
  std::string load_case, station;              ///< empty where the problem has none
  std::optional<Eigen::Isometry3d> tool_pose;  ///< nominal, in the measurement frame
  double contribution = 0.0;                   ///< share of all information, sums to 1 over the plan
};

struct PlannedParameter {
  Parameter label;
  std::optional<double> sigma;  ///< predicted 1σ after calibration, SI; none where not identifiable
  std::string dropped_because;  ///< equation among kept parameters; empty where it is kept
};

/// What is proved about a plan over its candidates.
struct Certificate {
  bool proved = true;                  ///< false: no bound is computed for this criterion, the rest says nothing
  double efficiency = 0.0;             ///< lower bound of (det M / det M*)^{1/s}, in (0, 1]
  double log_det_bound = 0.0;          ///< no plan of as many of these candidates exceeds it; same scale as log_det
  double max_sensitivity_ratio = 1.0;  ///< how near the weights behind the bound are to their own optimum
  std::size_t count = 0;               ///< candidates
  bool repeats = false;                ///< whether the bound allows repeats
};

struct PlanStatistics {
  long drawn = 0, feasible = 0;
  std::vector<std::pair<std::string, long>> rejected;
  long exchanges = 0;
  int restarts = 0;
  double seconds = 0.0;
  std::optional<double> poses_on_boundary;      ///< share of poses on the boundary of the feasible set
  std::optional<double> coordinates_on_limits;  ///< share of coordinates on a limit
};

/// Everything that is written about a plan.
struct Plan {
  std::uint64_t seed = 0;
  std::string problem_file, problem_sha256;
  std::string variant;  ///< empty for a plan from bare blocks
  std::string criterion = "o1";
  double criterion_value = 0.0;  ///< in its own terms (docs/plan-file.md)
  std::optional<double> rho0;    ///< predicted position error at the test poses, root of the weighted mean square, m
  std::vector<double> test_errors{};  ///< the same at each test pose, m
  bool prior = false;                 ///< tolerances count as prior knowledge in log_det, σ and everything else
  double log_det = 0.0, log_det_full = 0.0;
  ObservabilityIndices indices;
  double condition = 0.0;
  Certificate certificate;
  std::vector<PlannedParameter> parameters;  ///< interest first, then nuisance, then dropped ones
  std::vector<PlannedPose> poses;
  PlanStatistics statistics;
  bool interrupted = false;  ///< the search was ended before it was done
};

}  // namespace posewright
