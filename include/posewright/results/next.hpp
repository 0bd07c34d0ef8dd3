#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/problem/calibrated_parameters.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/plan.hpp"

namespace posewright {

struct KeptCandidates;  // tasks/next_poses.hpp

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

/// Text for the terminal: state of the calibration, verdict, the next poses in deg and mm.
std::string next_text(const NextPoses& result);
/// Verdict and reason, in a sentence or two.
std::string next_reason(const NextPoses& result);
/// The next poses in deg and mm, with criterion and candidates.
std::string proposed_text(const NextPoses& result);
/// "reached", …
std::string verdict_name(NextVerdict verdict);

/// Schema posewright/next/1, SI.
/// @param data     file of the measured poses; empty: nothing is measured
/// @param history  earlier verdicts with their numbers of poses; empty: none
nlohmann::ordered_json next_json(const Problem& problem, std::uint64_t seed, const std::string& data,
                                 const NextPoses& result, const std::vector<NextPoint>& history = {});

/// The next poses alone, as in next_json().
nlohmann::ordered_json proposed_json(const NextPoses& result);

/// One line for each pose, as a plan's pose list.
std::string next_csv(const NextPoses& result);

}  // namespace posewright
