#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/calibration/axis_errors.hpp"
#include "posewright/calibration/compensator_constants.hpp"
#include "posewright/calibration/curvature.hpp"
#include "posewright/calibration/fit.hpp"
#include "posewright/calibration/frame_step.hpp"
#include "posewright/calibration/in_steps.hpp"
#include "posewright/calibration/instrument_residuals.hpp"
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
#include "posewright/model/dh_table.hpp"
#include "posewright/model/placed_frames.hpp"
#include "posewright/results/plan.hpp"

namespace posewright {

/// Files of readings that a calibration is of.
struct MeasuredFiles {
  std::filesystem::path data;
  /// More files of the same robot, each a campaign: the instrument or the tool was moved between them.
  std::vector<std::filesystem::path> campaigns{};
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
  std::vector<InstrumentResiduals> instruments{};  ///< of a list, fitted poses
  bool placed = false;                             ///< there are residuals with base, tool and nuisance alone
  std::vector<AxisImprovement> axes;               ///< of fitted poses, then of those held back
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

/// One model of several that were fitted to the same data.
struct JudgedModel {
  std::string variant;
  double parameters = 0.0;  ///< that the readings pay for: tr(H), less than estimated where tolerances count
  double left_out = 0.0;    ///< root mean square of whitened residuals of poses left out; infinite: none
  /// n ln(Σr²/n) + 2k + 2k(k + 1)/(n − k − 1), k = parameters + 1 for the size of the noise (Hurvich & Tsai 1989,
  /// Biometrika 76(2)); none where readings are too few, or count as correlated or robustly.
  std::optional<double> aicc{};
  /// The largest of the others that estimates some of this one's parameters and no others; empty: none.
  std::string against;
  /// F test of the parameters beyond it; none as for aicc.
  std::optional<double> f{}, probability{};
};

struct ModelChoice {
  std::vector<JudgedModel> models;  ///< in the order given
  std::string recommended;          ///< empty: none
  std::string why;
};

/// ols, wls or robust, as in files and on the command line.
std::string weighting_word(Weighting weighting);
/// Its inverse; weighted for an empty word. The word is one of these.
Weighting weighting_of(std::string_view word);

/// "use it", "gain not shown", "do not use".
std::string verdict_word(Verdict verdict);

/// Text for the terminal: parameters with intervals, residuals before and after, tests of the model.
std::string calibration_text(const Calibration& calibration);
/// Complete JSON: schema posewright/calibration/1.
/// @param table  of the calibrated arm; empty: none was asked for
nlohmann::ordered_json calibration_json(const Problem& problem, const MeasuredFiles& files,
                                        const Calibration& calibration, const std::optional<DhTable>& table = {});

/// Several models of one robot, judged on the same data; schema posewright/calibrations/1.
std::string models_text(const std::vector<Calibration>& models, const ModelChoice& choice);
nlohmann::ordered_json models_json(const Problem& problem, const MeasuredFiles& files,
                                   const std::vector<Calibration>& models, const ModelChoice& choice);

/// Constants of a compensator from listed compliances; schema posewright/compensator/1.
std::string compensator_text(const CompensatorConstants& constants);
nlohmann::ordered_json compensator_json(const Problem& problem, const MeasuredFiles& files,
                                        const CompensatorConstants& constants);

/// The map of a platform's deformation as a picture: displacement of every joint centre over its own actuator,
/// measured, by κ and by K.
std::string platform_svg(const PlatformDeformation& platform);

}  // namespace posewright
