#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "posewright/blocks/parameter.hpp"
#include "posewright/blocks/pose_choices.hpp"
#include "posewright/criterion/observability_indices.hpp"
#include "posewright/support/key_edit.hpp"
#include "posewright/support/robust_aim.hpp"

namespace posewright {

struct Problem;

/// A named value with its unit: one entry of a configuration or an actuator.
struct NamedValue {
  std::string name;
  std::string unit;
  double value = 0.0;
};

/// A target as the instrument's station sees it from one pose.
struct TargetSight {
  std::string target, station;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< predicted, station frame, m
  double distance = 0.0, azimuth = 0.0, elevation = 0.0;
  std::optional<double> incidence;  ///< rad from the target's normal
  bool judged = false;              ///< whether the problem asks for line of sight
  std::string hidden_by;            ///< why it is not seen; empty: it is, if that was judged
};

/// Two bodies and how far they are apart.
struct BodyDistance {
  double distance = 0.0;  ///< m
  std::string first, second;
  /// Nearest points: one of the first and one of the second, measurement frame, m; none: not known.
  std::optional<std::array<Eigen::Vector3d, 2>> points{};
};

struct PlannedPose {
  int id = 0;                    ///< 1, 2, … in measuring order
  std::optional<int> candidate;  ///< zero-based index in the candidate set; none: found between them
  /// The pose in the list that the candidates came from; `candidate` is then its index there.
  struct Listed {
    int id = 0;    ///< as the list calls it
    int line = 0;  ///< of its file; 0: not known
  };
  std::optional<Listed> listed{};
  bool measured = false;                  ///< was there before: not to be measured again
  bool fixed = false;                     ///< was in the plan before the search, still to be measured
  std::vector<NamedValue> configuration;  ///< empty for a plan made from bare blocks
  std::vector<NamedValue> actuators;      ///< of a parallel robot
  PoseChoices choices{};
  std::optional<Eigen::Isometry3d> tool_pose;  ///< nominal, in the measurement frame
  std::vector<TargetSight> sights;             ///< where to look for the targets
  std::optional<BodyDistance> nearest{};       ///< of the bodies that are checked for collision
  double contribution = 0.0;                   ///< share of all information, sums to 1 over the plan
  /// Efficiency of the plan without this pose relative to the plan, in [0, 1]; 0: it cannot do without.
  double without = 1.0;
};

struct PlannedParameter {
  Parameter label;
  std::string variant;          ///< empty if the plan serves one
  std::optional<double> sigma;  ///< predicted 1σ after calibration, SI; none if not identifiable
  std::string dropped_because;  ///< equation among kept parameters; empty if it is kept
};

/// Proof about a plan over its candidates, and result of a search over the whole workspace. Bounds are of Φ,
/// what the search maximises: log det, −ln of a variance, or ln of an efficiency (theory.md).
struct Certificate {
  bool proved = true;                  ///< false: the criterion has no bound, the rest says nothing
  double efficiency = 0.0;             ///< lower bound of what the plan reaches of the best, in (0, 1]
  double bound = 0.0;                  ///< no plan of as many of these candidates exceeds it
  double max_sensitivity_ratio = 1.0;  ///< how near the weights behind the bound are to their own optimum
  std::size_t count = 0;               ///< candidates
  std::size_t found = 0;               ///< how many of them were found by searches, beyond those drawn
  std::string repeats = "forbid";      ///< what the bound allows: forbid, allow or a number
  bool apart = false;                  ///< the bound is of plans alone that keep the minimum distance
  bool limited = false;                ///< and of those within the numbers of poses of instruments (`most`)
  struct Workspace {
    double efficiency = 0.0, bound = 0.0, max_sensitivity_ratio = 1.0;
    std::string method;                 ///< how the largest sensitivity was sought
    bool proved = false;                ///< no plan within the limits exceeds the bound; else a search says so
    std::string why_not;                ///< why it is not proved
    long boxes = 0;                     ///< that a proof took
    std::vector<std::string> limits{};  ///< what a proof counts beside `within`: "tool box"
    /// Region of the bound: "within the joint limits less 2 deg", then further
    /// conditions of the proof.
    std::string within{};
    /// A proof far below what the search says: it holds all the same.
    std::optional<double> loose_bound{};
    double loose_efficiency = 0.0;
    /// True if a search without proof was finished; otherwise its efficiency is not shown.
    bool settled = true;
    double reached = 0.0;  ///< Φ of the best weights found: some plan may be as good
    double at_most = 1.0;  ///< no more than this share of the best: that of these weights
  };
  std::optional<Workspace> workspace;
};

/// One variant of a plan that serves several.
struct VariantResult {
  std::string name;
  double weight = 1.0;
  double log_det = 0.0;     ///< of its interest information
  double bound = 0.0;       ///< that no plan of as many of these candidates exceeds
  double efficiency = 0.0;  ///< of this plan for it, against that bound
};

/// Results of plans of other sizes.
struct CurvePoint {
  int poses = 0;
  double log_det = 0.0;
  std::optional<double> rho0;          ///< m
  std::optional<double> worst_sigma;   ///< largest σ / required σ
  bool enough = false;                 ///< whether everything required is reached
  std::optional<double> worst_axis{};  ///< largest 95 % half width along or about an axis / what is required
};

struct PlanStage {
  std::string name;
  double value = 0.0;                ///< Φ of the best so far
  std::optional<double> efficiency;  ///< of it against the candidates' bound; may exceed 1 between the candidates
  double seconds = 0.0;
};

/// Constraints as applied by the cell.
struct CellNotes {
  std::vector<std::string> always_touching;  ///< pairs of links that are not checked
  std::vector<BodyDistance> reduced;         ///< pairs that cannot keep their clearance by design, and what they keep
  double margin = 0.0;                       ///< m, largest that was added to a clearance before calibration
  std::vector<NamedValue> joint_margins{};   ///< the same for limits
};

/// Margin of proposed poses to a coordinate's limits.
struct LimitMargin {
  std::string name, unit;
  double margin = 0.0;   ///< rad or m, at the nearer end
  bool standard = true;  ///< nobody asked for it
};

struct PlanStatistics {
  long drawn = 0, feasible = 0;
  std::vector<std::pair<std::string, long>> rejected;
  std::string list{};                ///< that the candidates came from; empty: they were drawn
  std::vector<std::string> notes{};  ///< what the user must know of it
  long exchanges = 0;
  int restarts = 0;
  double seconds = 0.0;
  std::optional<double> poses_on_boundary;      ///< share of poses on the boundary of the feasible set
  std::optional<double> coordinates_on_limits;  ///< share of coordinates on a limit
  std::vector<PlanStage> stages{};
  CellNotes cell{};
  std::vector<LimitMargin> limit_margins{};
};

/// The test that tells the fitted variant from another one that is the case: the sum of squared residuals after the
/// fit, noise known, against the chi-square distribution.
struct Discrimination {
  std::string truth;
  /// Noncentrality λ: what fitting leaves of the effects, whitened. By nominal values it is known; by tolerances, one
  /// off each, it is the expected value.
  std::optional<double> by_nominal, by_tolerance;
  int readings = 0, fitted = 0;         ///< what is read, parameters that are estimated (nuisance ones too)
  double level = 0.05;                  ///< chance to reject the fitted variant where it is the case
  double wanted = 0.9;                  ///< the power that repetitions are to reach
  std::optional<double> power;          ///< chance to reject it where the truth is; none without a degree of freedom
  std::optional<double> power_along;    ///< of the test along the effect, one degree of freedom; by nominal alone
  std::optional<int> repetitions = {};  ///< of the whole measurement, for the wanted power; none: a million are too few
  std::optional<int> repetitions_along = {};

  double noncentrality() const { return by_nominal.value_or(0.0) + by_tolerance.value_or(0.0); }
  int degrees_of_freedom() const { return readings - fitted; }
};

/// An effect that the fitted variant lacks, as the plan allows for it.
struct PlannedEffect {
  double size = 0.0, rotation = 0.0, length = 0.0;  ///< 1σ m and rad; rad
  bool size_assumed = false;                        ///< nobody stated it
  int features = 0;                                 ///< that stood for it in the search
  /// log det of the plan with the features less that with the whole effect.
  double feature_error = 0.0;
  /// Parts of rho0, if there are test poses: by noise alone (the part of it that repeatability has), by the effect; and
  /// in all if what is left is interpolated, m.
  std::optional<double> by_noise{}, by_repeatability{}, by_effect{}, interpolated{};
};

/// Position error to expect after a calibration (theory.md eq. (68)): root mean square at the places that count, as the
/// instrument sees it. The best rigid base and tool are taken out where the readings cannot tell them from nuisance
/// parameters.
struct ExpectedError {
  /// Sizes of an effect that robots have, in units of the noise of a pose: least, usual, largest (docs/real-data.md).
  static constexpr std::array<double, 3> robots = {0.5, 2, 5};
  static constexpr double usual_of_robots = robots[1];
  /// Places that count: the problem's, candidates, or drawn between the least and largest measured value of each joint.
  enum class At { test_poses, candidates, measured_ranges };
  /// Origin of the size: the table of robots, the variant's `unmodelled`, a calibration.
  enum class Size { of_robots, counted, measured };
  struct WithEffect {
    double size = 0.0;   ///< 1σ along each axis, m
    double error = 0.0;  ///< m

    static auto fields(auto& own) { return std::tie(own.size, own.error); }
  };
  double noise = 0.0;   ///< of one pose's readings as a displacement of the tip, 1σ along each axis, m
  double length = 0.0;  ///< over which the effect changes, rad
  At at = At::candidates;
  int places = 0;                           ///< how many of them
  bool base_out = false, tool_out = false;  ///< whether the best one is taken out
  double by_noise = 0.0;                    ///< from noise alone, m
  double amplification = 0.0;               ///< of the effect by the estimate; 1: the error equals the unfitted effect
  Size size = Size::of_robots;              ///< that `with` counts
  std::vector<WithEffect> with{};           ///< one, or least, usual and largest
  std::optional<double> required{};         ///< by the user, m

  const WithEffect& usual() const { return with[with.size() / 2]; }
  static auto fields(auto& own) {
    return std::tie(own.noise, own.length, own.at, own.places, own.base_out, own.tool_out, own.by_noise,
                    own.amplification, own.size, own.with, own.required);
  }
};

/// What one instrument of a list gives a plan.
struct InstrumentWorth {
  std::string name;
  int poses = 0;       ///< that it reads
  double share = 0.0;  ///< tr(M_k ∂Φ/∂M) / tr(M ∂Φ/∂M), M_k its information; all shares and the prior's add to one
  double setup = 0.0, reading = 0.0;  ///< s, before its first pose and of all its readings
  /// The plan without its poses: efficiency relative to the plan (0: the others leave parameters open), σ of the first
  /// variant's parameters by name, error to expect.
  double without = 0.0;
  std::vector<std::pair<std::string, double>> sigma_without{};
  std::optional<ExpectedError> expected_without{};
};

/// Efficiency of a plan, and of the plan for the nominal robot, on robots drawn from the tolerances.
struct RobustPlan {
  int draws = 0;
  RobustAim aim;
  bool searched = true;  ///< false: a given list, which was judged alone
  /// For every drawn robot: log det that no plan of as many of the candidates exceeds; D-efficiency against it.
  std::vector<double> references, nominal, efficiency;
  double nominal_value = 0.0, value = 0.0;  ///< the measure of them: a geometric mean, the least, that of the worst
  double bound = 1.0;                       ///< of the measure: no plan of as many of these candidates exceeds it
  long unreached = 0;    ///< pairs of robot and candidate where that robot cannot stand or be measured
  bool stopped = false;  ///< the search was ended before it was done

  /// Gain below which the robust plan is no use against the nominal one.
  static constexpr double of_no_use = 0.01;
  double gain() const { return value / nominal_value - 1; }
  bool worth_it() const { return gain() > of_no_use; }
};

/// The problem that a plan, route or evaluation was made for, as its file states it.
struct ProblemOrigin {
  std::string file, sha256;     ///< of a plan from bare blocks: those of the blocks
  ParametersFile parameters{};  ///< no file: nominal ones
  KeyEdits changed{};           ///< Problem::changed without files of poses
};
ProblemOrigin origin_of(const Problem& problem);

/// All data of a written plan.
struct Plan {
  std::uint64_t seed = 0;
  ProblemOrigin problem{};
  std::string variant;  ///< empty for a plan from bare blocks
  std::string criterion = "o1", method = "exchange", scaling = "tolerance";
  bool determinant = true;       ///< the criterion is log_det, so that its bound is one of log_det
  bool by_test_poses = false;    ///< the criterion counts the test poses and nothing else
  bool reserve = false;          ///< searched for what is left without the pose that hurts most
  bool proved_optimal = false;   ///< no plan of these candidates is better that keeps the minimum distance
  std::string minimum_distance;  ///< of poses, for messages; empty: none is kept
  double criterion_value = 0.0;  ///< in its own terms (docs/plan-file.md)
  std::optional<double> rho0;    ///< predicted position error at the test poses, root of the weighted mean square, m
  std::vector<double> test_errors{};  ///< the same at each test pose, m
  std::optional<double> turn;         ///< as rho0, of the orientation: norm of the rotation vector, rad
  /// 1σ at each test pose along x, y, z (m) and about them (rad), measurement frame.
  std::vector<std::array<double, 6>> test_axes{};
  bool prior = false;  ///< tolerances count as prior knowledge in log_det, σ and everything else
  double log_det = 0.0, log_det_full = 0.0;
  ObservabilityIndices indices;
  double condition = 0.0;
  Certificate certificate;
  std::optional<Discrimination> discrimination;  ///< if a truth is named
  std::optional<PlannedEffect> unmodelled{};     ///< in σ, log det and predicted errors
  std::optional<RobustPlan> robust{};            ///< if robots were drawn
  std::optional<ExpectedError> expected{};       ///< of the first variant, if its readings contain a tip
  std::vector<VariantResult> variants{};         ///< of a plan for several
  std::vector<InstrumentWorth> instruments{};    ///< of a list
  double prior_share = 0.0;                      ///< of the information, beside those of the instruments of a list
  std::vector<CurvePoint> curve{};               ///< of a plan of the smallest number of poses
  std::optional<std::vector<CurvePoint>> other_numbers{};  ///< what other numbers of poses reach; none: not asked for
  std::vector<PlannedParameter> parameters;                ///< interest first, then nuisance, then dropped ones
  std::vector<PlannedPose> poses;
  PlanStatistics statistics;
  bool interrupted = false;  ///< the search was ended before it was done
};

/// A file that was written together with a plan or route, so that a later run knows it again.
struct WrittenWith {
  std::string path;    ///< as seen from the folder of the plan
  std::string sha256;  ///< of its bytes, lower-case hexadecimal
};

/// plan.json, schema posewright/plan/1 (docs/plan-file.md): SI units, shortest decimals that read back bit-equal.
/// @param files  that are written with it
std::string plan_json(const Plan& plan, const std::vector<WrittenWith>& files = {});

/// One line for each pose that is still to be measured: id, configuration, actuators; header `name [unit]`. Empty for a
/// plan without configurations.
std::string poses_csv(const Plan& plan);

/// The table a person reads: certificate, parameters with σ against tolerance (mm, deg), where candidates were lost.
std::string plan_summary(const Plan& plan);

}  // namespace posewright
