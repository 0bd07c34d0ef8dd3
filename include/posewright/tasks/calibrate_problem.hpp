#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/axis_errors.hpp"
#include "posewright/calibration/compensator_constants.hpp"
#include "posewright/calibration/curvature.hpp"
#include "posewright/calibration/frame_step.hpp"
#include "posewright/calibration/in_steps.hpp"
#include "posewright/calibration/interpolation.hpp"
#include "posewright/calibration/leave_out.hpp"
#include "posewright/calibration/orientation.hpp"
#include "posewright/calibration/platform_deformation.hpp"
#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/calibration/revisits.hpp"
#include "posewright/calibration/score_tests.hpp"
#include "posewright/calibration/smooth_effect.hpp"
#include "posewright/calibration/tip_errors.hpp"
#include "posewright/calibration/visit_errors.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/model/placed_frames.hpp"
#include "posewright/outputs/plan.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Parameters whose intervals are by profile (posewright::Profile): those that the curvature names, none, or those that
/// these names and globs match.
struct ProfileChoice {
  enum Choice { automatic, none, named };
  Choice choice = automatic;
  std::vector<std::string> names{};
};
/// From what a user wrote: auto, none, all, or names and globs with commas between them. Throws InputError for an empty
/// name.
ProfileChoice profile_choice(const std::string& text);

/// Frame that moved before each further campaign: the base (where the instrument stands), the tool (all that the tip
/// carries: tool, targets, a camera or board), both, or nothing. automatic: the base, and the tool if the residuals ask
/// for it.
enum class Moved { automatic, base, tool, both, nothing };
/// By its word: auto, base, tool, both, nothing. Throws InputError for another one.
Moved moved_between(const std::string& text);

struct CalibrateOptions {
  std::filesystem::path data;
  std::optional<std::string> text{};  ///< of `data`, if the file is not to be read: it holds more than counts
  /// More files of the same robot, each a campaign: the instrument or the tool was moved between them.
  std::vector<std::filesystem::path> campaigns{};
  Moved moved = Moved::automatic;  ///< between campaigns
  std::string variant;             ///< empty: as in the file
  Weighting weighting = Weighting::weighted;
  /// Use of manufacturing and stated tolerances as prior knowledge; none: plain least squares.
  Prior prior = Prior::manufactured;
  std::filesystem::path validate;  ///< more data that are not fitted; empty: none
  int hold_back = 0;               ///< every so many-th pose is not fitted; 0: none
  bool in_steps = false;           ///< identify base and tool, geometry, stiffness one after the other, too
  bool estimate_alone = false;     ///< the estimate and the smooth effect that the residuals show, no other judgement
  ProfileChoice profile{};
  bool interpolate = false;  ///< add interpolated residuals to predictions: a variant with `unmodelled`
  int threads = 0;           ///< 0: all
};

/// One parameter of a calibrated variant.
struct CalibratedParameter {
  Parameter label;  ///< nominal value: before
  bool estimated = true;
  bool prior = false;                ///< its tolerance counted
  double spread = 1.0;               ///< so many times, where it is assumed and the readings told its size
  double value = 0.0, sigma = 0.0;   ///< SI
  double lower = 0.0, upper = 0.0;   ///< 95 % interval; infinite: no end on that side
  bool profiled = false;             ///< the interval is by profile, see Profile
  double half_width = 0.0;           ///< of the linear interval
  std::string why_not{};             ///< not estimated: parameters that the data cannot separate it from
  std::vector<std::string> given{};  ///< left-out parameters that this value depends on: it has neither σ nor interval
  bool weak = false;                 ///< the data tell less than the tolerance
  std::optional<double> in_steps{};  ///< identified in steps, where that was asked for
};

/// Residuals of one set of poses with parameters of one kind.
struct ResidualSet {
  std::string poses;       ///< "fitted", "held back"
  std::string parameters;  ///< "nominal", "base and nuisance only", "calibrated"
  std::vector<ResidualSummary> kinds;
};

/// Errors along one axis, before and after.
struct AxisImprovement {
  std::string poses;         ///< "fitted", "held back"
  AxisErrors before, after;  ///< placed (nominal if nothing is to be placed), calibrated
};

/// Limit of `design: require` for one axis, and the tip's largest error.
struct JudgedRequirement {
  std::string poses;  ///< "fitted", "held back"
  LargestTipError error;
  double required = 0.0;  ///< SI

  bool met() const { return error.largest <= required; }
  /// A larger error than is allowed, and the instrument alone makes as large ones.
  bool hidden_by_noise() const { return !met() && error.by_noise > required; }
  bool refused() const { return !met() && !hidden_by_noise(); }
};

/// Errors of a pose that was not fitted.
struct PoseAccuracy {
  PredictedError predicted;
  PoseError observed;
};

/// A pose with the residuals of its readings.
struct PoseResidual {
  int id = 0;
  bool held_back = false;
  std::vector<double> before;     ///< SI, NaN if not read; placed (nominal if nothing is to be placed)
  std::vector<double> residuals;  ///< calibrated, in the same order
  double weight = 1.0;            ///< smallest of its targets, robust fits
  std::optional<PoseAccuracy> accuracy{};
};

/// Verdict on an estimate: `gain_not_shown` has no significant gain over base and tool alone.
enum class Verdict { use_it, gain_not_shown, do_not_use };

struct Calibration {
  std::string variant;
  Weighting weighting = Weighting::weighted;
  Prior prior = Prior::none;
  bool automatic = false;  ///< the variant leaves it to the data which parameters are estimated
  int rows = 0, poses = 0, held_back = 0;
  double repeats = 1.0;
  std::vector<Reading> readings;
  std::vector<double> spread;  ///< of every reading within a pose, 1σ of one row; empty without repeats
  Fit fit;
  std::vector<CalibratedParameter> parameters;  ///< interest, nuisance, then those not estimated
  std::vector<CalibratedOrientation> orientations;
  std::vector<PlacedFrame> frames;  ///< where the estimate puts them; empty: none was estimated
  LeaveOut left_out;                ///< does the estimate predict poses that it has not seen?
  std::string weakest;              ///< weakest_combination()
  ResidualTests tests;
  std::vector<ScoreTest> effects;       ///< not fitted, beside the fit that counts no smooth effect; best first
  std::optional<VisitErrors> visits{};  ///< counted beside the stated repeatability
  std::optional<FrameStep> step{};      ///< of a file alone: a frame that stands elsewhere from some pose on
  SmoothEffect smooth;                  ///< that the residuals of a fit hold which counts none
  /// Unmodelled effect of the fit; none: readings of different poses are independent.
  std::optional<CalibratedEffect> counted{};
  std::optional<ExpectedError> expected{};       ///< none: see calibrated_error()
  Revisits revisits;                             ///< configurations measured again after others
  std::vector<std::string> not_in_auto{};        ///< parameters of the model that an automatic variant leaves out
  std::optional<Interpolation> interpolation{};  ///< if it was asked for
  TestResult lack_of_fit;                        ///< posewright::lack_of_fit()
  Curvature curvature;
  std::vector<ResidualSet> residuals;
  bool placed = false;                ///< there are residuals with base, tool and nuisance alone
  std::vector<AxisImprovement> axes;  ///< of fitted poses, then of those held back
  std::vector<JudgedRequirement> requirements;
  std::vector<PoseResidual> pose_residuals;
  std::optional<StepwiseFit> in_steps;
  std::optional<CompensatorConstants> compensator;
  std::optional<PlatformDeformation> platform;  ///< if the data have the joint centres of a platform
  std::vector<std::string> columns;             ///< names of the columns of fit.covariance and curvature.parameter
  std::vector<std::string> notes;
  Verdict verdict = Verdict::use_it;
  std::vector<std::string> refusals;  ///< why not; one at least where the verdict is do_not_use
  /// Corrections of the model's whole catalogue, for further use of the robot.
  std::vector<double> correction;
  std::vector<EstimatedValue> values;  ///< the same as values, under the model's names, with σ where estimated
};

/// The frame whose orientation this parameter is an angle of; null: it is none, or is estimated without the others.
const CalibratedOrientation* turned_frame(const Calibration& calibration, const CalibratedParameter& parameter);

/// The smooth effect for the next plan: from the residuals
/// at 5 %; none: nothing.
std::optional<CalibratedEffect> shown_effect(const Calibration& calibration);

/// Estimates the parameters of a variant from measured data. Columns that the data do not determine stay at their
/// nominal values and are listed. Throws InputError (files) and CannotDo (nothing can be estimated).
Calibration calibrate_problem(const Problem& problem, const CalibrateOptions& options, const Monitor& monitor);

}  // namespace posewright
