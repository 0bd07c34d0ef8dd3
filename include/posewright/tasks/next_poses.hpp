#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "posewright/blocks/parameter.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/lists/pose_list.hpp"
#include "posewright/outputs/plan.hpp"
#include "posewright/problem/calibrated_parameters.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// Candidates that were drawn for an earlier call, so that a later one need not draw them.
struct KeptCandidates {
  Configurations configurations;
  int asked = 0;            ///< how many were to be drawn
  bool calibrated = false;  ///< drawn after a fit, where the robot really stands
};

struct NextOptions {
  std::filesystem::path data;         ///< names `text` in messages
  std::optional<std::string> text{};  ///< measured data, whole lines; none: nothing yet
  std::string variant, criterion;     ///< empty: as in the problem; criterion: see NextPoses::criterion
  int poses = 1;                      ///< wanted
  std::optional<double> required{};   ///< error at the test poses, m; none: design: require: accuracy
  Prior prior = Prior::manufactured;  ///< tolerances that count, as in a calibration
  std::optional<int> candidates{};
  std::optional<PoseList> candidates_from{};  ///< choose among these; none: as in the problem
  std::shared_ptr<const KeptCandidates> kept{};
  std::uint64_t seed = 0;
  int threads = 0;
};

/// Why another pose is worth measuring or not.
enum class NextVerdict {
  not_determined,  ///< the poses do not tell all parameters yet
  go_on,
  reached,  ///< all that is required is met with 95 % confidence
  flat,     ///< three more poses lower the expected error by less than 2 %
};

/// Error at the test poses after so many poses, m; none: these poses do not tell all parameters.
struct NextPoint {
  int poses = 0;
  std::optional<double> expected{};  ///< ExpectedError::usual(); where the readings tell of no tip, ρ0
  std::optional<double> upper{};  ///< 95 %, whatever effect the residuals leave possible; of all measured poses alone
};

/// One of the things that a problem requires, after the measured poses. SI.
struct NextRequirement {
  std::string what;  ///< "accuracy", "position x" … "rotation z", "sigma NAME"
  std::string unit;
  double required = 0.0;
  std::optional<double>
      expected{};  ///< NextPoint::expected; 1σ along or about the axis at the worst test pose; σ of the parameter
  std::optional<double> upper{};  ///< 95 %, the compared value

  bool met() const { return upper && *upper <= required; }
};

struct NextPoses {
  std::string variant;
  /// Named by option or problem; for `auto` o1 below 1.5 times the smallest number of poses and test_pose from there
  /// on.
  std::string criterion;
  int measured = 0, readings = 0;   ///< poses, single readings
  int parameters = 0, told = 0;     ///< columns, and how many the readings tell without any tolerance
  std::optional<int> smallest{};    ///< number of poses that tells all
  bool fitted = false;              ///< the rest is at calibrated values; else at nominal ones
  double noise = 1.0, freedom = 0;  ///< of the residuals, in units of the stated noise; their degrees of freedom
  std::optional<CalibratedEffect> effect{};  ///< smooth, that the residuals show and the fit counts
  std::optional<double> effect_below{};   ///< error by a missing effect, below it with 95 % confidence, m; none: no fit
  std::vector<EstimatedValue> estimates;  ///< of the parameters, if there was a fit
  /// After the measured poses; before a fit after those to be measured next, too.
  std::optional<ExpectedError> expected{};
  int places = 0;                         ///< where accuracy counts
  bool places_stated = false;             ///< test poses of the problem; else places through the workspace
  std::vector<NextPoint> curve;           ///< of the measured poses, by today's estimate; the last: all
  std::vector<NextPoint> ahead;           ///< with 1, 2, … of `poses`
  std::optional<NextPoint> with_three{};  ///< with the three that lower the error most
  std::optional<double> required{};
  /// All that is required, if the poses determine all parameters and there was a fit: reached means that each is met.
  std::vector<NextRequirement> requirements;
  NextVerdict verdict = NextVerdict::not_determined;
  std::vector<PlannedPose> poses;
  std::string candidates;  ///< how many, and where from, for messages
  std::shared_ptr<const KeptCandidates> kept;
  std::vector<std::string> notes;
  bool interrupted = false;
};

/// Decrease of the expected error by the next three poses; below it the curve is flat.
inline constexpr double least_gain = 0.02;
inline constexpr int poses_looked_ahead = 3;

/// Estimates the parameters from the measured data, then chooses the poses that add most to them, at the estimated
/// values and with the smooth effect of the residuals; reports their gain and whether they are needed.
/// Data that do not suffice for an estimate count by its poses alone, at the nominal values.
/// Throws InputError as the reading of problem, data and lists does, and for rows that are far from where a fit of the
/// rows before them says; CannotDo as make_study().
NextPoses next_poses(const Problem& problem, const NextOptions& options, const Monitor& monitor);

}  // namespace posewright
