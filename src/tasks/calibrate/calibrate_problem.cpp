#include "posewright/tasks/calibrate_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "calibrated_error.hpp"
#include "calibration_columns.hpp"
#include "calibration_data.hpp"
#include "calibration_effects.hpp"
#include "calibration_profiles.hpp"
#include "calibration_verdict.hpp"
#include "placed_campaigns.hpp"
#include "posewright/calibration/frame_limits.hpp"
#include "posewright/calibration/frame_shift.hpp"
#include "posewright/calibration/instrument_noise.hpp"
#include "posewright/calibration/placing_columns.hpp"
#include "posewright/model/campaigns.hpp"
#include "posewright/model/elastic_chain.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

// So often an estimate may be replaced by a better one that its profiles passed.
constexpr int most_rounds = 4;
// With a prior, σ is below the tolerance anyhow: here data and prior tell as much as each other.
constexpr double prior_share = 1 / std::numbers::sqrt2;
// So many intervals no effect that is one of several moves an estimate.
constexpr double far_moved = 10.0;
// Sizes of noise and of a visit's displacements that move by less, the estimate and they in turn.
constexpr double settled_sizes = 1e-2;

class CalibrationRun {
 public:
  CalibrationRun(Problem problem, const CalibrateOptions& options, const Monitor& monitor)
      : problem_(std::move(problem)),
        options_(options),
        monitor_(monitor),
        spec_(find_variant(problem_, options.variant)),
        campaigns_(campaigns_of(options)),
        model_(model_of(problem_)) {
    result_.variant = spec_.name;
    result_.weighting = options.weighting;
    result_.prior = options.prior;
    read();
    if (std::string warning = compensator_warning(problem_.robot, model_->coordinates()); !warning.empty())
      result_.notes.push_back(std::move(warning));
  }

  Calibration run() {
    report(0);
    FitOptions fit_options;
    fit_options.weighting = options_.weighting;
    fit_options.prior = result_.prior;
    VariantColumns all = select_columns(*model_, {problem_, spec_});
    if (!campaigns_.empty()) all = with_campaign_columns(*model_, all);
    fit_options.components = result_.prior != Prior::none;
    fit_options.limits = frame_limits(*model_, all, result_.prior);
    refuse_mixed_targets(problem_.measurement, fitted_, options_.weighting);
    try {
      choose_and_place(all, fit_options);
    } catch (const CannotDo&) {
      refuse_unplaced(problem_, *model_, fitted_, orientation_);
      throw;
    }
    refuse_gross_poses(*model_, columns_, fitted_, placed_, fit_options, result_.notes);
    refuse_conventions(problem_, *model_, columns_, fitted_, placed_, orientation_);
    if (options_.estimate_alone) {
      fit_readings(fit_options);
      return estimate_alone(fit_options);
    }
    estimate_with_profiles(fit_options);
    report(1);
    result_.correction = result_.fit.correction;
    result_.weakest = weakest_combination(result_.fit, columns_);
    if (result_.fit.converged)
      result_.left_out = leave_out(*model_, columns_, fitted_, fit_options, placed_, result_.fit, monitor_);
    if (options_.interpolate) result_.interpolation = interpolation_of(spec_, poses(), fit_options.effect, result_);
    judge_noise();
    judge_instruments(fit_options);
    note(note_of_step(result_.step));
    note_visits();
    judge_calibration(poses(), result_);
    judge_frame();
    fill_parameters();
    fill_accuracy(poses(), problem_.design.require, result_);
    expect();
    if (const auto* arm = std::get_if<SerialArmSpec>(&problem_.robot); arm != nullptr && arm->elastostatic)
      fill_compensator(*arm->elastostatic, result_);
    if (options_.in_steps) identify_in_steps(fit_options);
    report(2);
    return std::move(result_);
  }

 private:
  CalibratedPoses poses() const { return {problem_.measurement, *model_, columns_, fitted_, held_back_, placed_}; }

  void expect() {
    // Nothing else depends on a workspace that cannot be drawn from.
    if (!campaigns_.empty()) return;
    try {
      result_.expected = calibrated_error({problem_, spec_}, columns_, fitted_, result_, monitor_);
    } catch (const std::runtime_error& error) {
      result_.notes.push_back(std::string("no error is predicted: ") + error.what());
    }
  }

  /// Corrections for further use of the robot.
  Calibration estimate_alone(FitOptions& fit_options) {
    allow_for_unmodelled(fit_options);
    result_.correction = result_.fit.correction;
    result_.instruments = instrument_residuals(*model_, columns_, fitted_, result_.fit);
    fill_parameters();
    report(2);
    return std::move(result_);
  }

  /// From the other side where the fit left the canonical range of a frame's angles.
  void fit_canonical(FitOptions& fit_options) {
    result_.fit = fit(*model_, columns_, fitted_, fit_options);
    std::vector<double> canonical = result_.fit.correction;
    if (!take_canonical_angles(*model_, columns_, canonical)) return;
    fit_options.start = std::move(canonical);
    result_.fit = fit(*model_, columns_, fitted_, fit_options);
  }

  /// By the noise that instruments of a list show.
  void fit_readings(FitOptions& fit_options) {
    fit_canonical(fit_options);
    count_instrument_noise(fit_options);
  }

  /// With everything that the residuals say of it.
  void estimate(FitOptions& fit_options) {
    fit_readings(fit_options);
    test_estimate();
    if (count_visits(fit_options)) test_estimate();
    if (campaigns_.empty())
      result_.step =
          frame_step(*model_, columns_, fitted_, result_.fit, frames_that_may_move(problem_.measurement, *model_));
    result_.revisits = revisits(*model_, fitted_, result_.fit.correction);
    allow_for_unmodelled(fit_options);
    result_.curvature = curvature(*model_, columns_, fitted_, result_.fit);
    result_.orientations = orientations(*model_, columns_, result_.fit, stretch());
  }

  void test_estimate() {
    result_.tests = test_residuals(result_.fit);
    test_correlations(*model_, columns_, fitted_, result_.fit, result_.tests);
    result_.effects = effects_left_out({problem_, spec_}, *model_, columns_, fitted_, result_.fit,
                                       [this](const Problem& wider) { return model_of(wider); });
  }

  /// Instruments of a list whose residuals show a larger noise than stated count with that.
  void count_instrument_noise(FitOptions options) {
    // Effects that instruments are known to have are in what they show, and count later.
    if (options.weighting != Weighting::weighted || (spec_.unmodelled && !own_effects(problem_.measurement).empty()))
      return;
    for (int round = 0; round < most_rounds; ++round) {
      const InstrumentNoise noise = instrument_noise(*model_, columns_, fitted_, result_.fit, result_.prior);
      if (!noise.shown()) return;
      const auto at = *instrument_index(model_->coordinates());
      bool moved = false;
      for (std::vector<MeasuredPose>* poses : {&fitted_, &held_back_, &validation_})
        for (MeasuredPose& pose : *poses) {
          const double before = std::exchange(pose.noise_factor, noise.factors[std::size_t(pose.q[at])]);
          moved = moved || !settled(pose.noise_factor, before);
        }
      if (!moved) return;
      options.start = result_.fit.correction;
      fit_canonical(options);
    }
  }

  /// True if the readings of a pose show displacements of a visit that nobody stated: the estimate counts them. An
  /// effect that most of the residuals are is no chance of a visit.
  bool count_visits(const FitOptions& fit_options) {
    if (result_.visits || !std::holds_alternative<PointsMeasurement>(problem_.measurement.instrument) ||
        !(result_.fit.noise_factor > 1) || fit_options.weighting != Weighting::weighted ||
        std::ranges::any_of(result_.effects, &ScoreTest::dominates))
      return false;
    const Repeatability stated = problem_.measurement.repeatability;
    std::unique_ptr<IdentificationModel> as_stated = std::exchange(model_, nullptr);
    const auto found = [&] { return visit_errors(*as_stated, stated, columns_, fitted_, result_.fit, result_.prior); };
    VisitErrors visits = found();
    if (visits.contradicts()) contradicted_visits_ = visits;
    if (!visits.shown()) {
      model_ = std::move(as_stated);
      return false;
    }
    FitOptions again = fit_options;
    for (int round = 0; round < most_rounds; ++round) {
      count(visits, stated);
      again.start = result_.fit.correction;
      fit_canonical(again);
      const VisitErrors before = std::exchange(visits, found());
      if (settled(before.translation, visits.translation) && settled(before.rotation, visits.rotation)) break;
    }
    place_again(fit_options);
    return true;
  }

  static bool settled(double before, double after) { return std::abs(after - before) <= settled_sizes * before; }

  /// The fit's noise factor counts all of the covariance, these displacements too.
  void count(const VisitErrors& visits, Repeatability stated) {
    result_.visits = visits;
    stated.translation = std::hypot(stated.translation, visits.translation / visits.noise);
    stated.rotation = std::hypot(stated.rotation, visits.rotation / visits.noise);
    problem_.measurement.repeatability = stated;
    model_ = model_of(problem_);
    model_->take_loads_at(placed_);
  }

  void note_visits() {
    if (contradicted_visits_) note(note_of_contradiction(*contradicted_visits_));
    note(note_of_visits(result_.visits));
  }

  /// A profile may pass a better estimate than the one that it began at.
  void estimate_with_profiles(FitOptions& fit_options) {
    const std::vector<int> named = columns_to_profile(options_, columns_);
    const FitOptions plain = fit_options;
    const std::size_t noted = result_.notes.size();
    for (int round = 0; round == 0 || (profiled_.profiles.better > 0 && round < most_rounds); ++round) {
      if (round > 0) {
        fit_options = plain;
        fit_options.start = profiled_.profiles.better_estimate;
        // What was said of the estimate that is replaced, and what it counted.
        result_.notes.resize(noted);
        result_.counted.reset();
      }
      estimate(fit_options);
      profiled_ = profiles_of({*model_, columns_, fitted_, fit_options}, options_, named, stretch(), result_, monitor_);
    }
  }

  double stretch() const { return interval_factor(interval_probability, result_.fit.scale_known, result_.fit.freedom); }

  void read() {
    CalibrationData data = read_calibration_data(problem_, options_, *make_model({problem_, spec_}), result_);
    fitted_ = std::move(data.fitted);
    held_back_ = std::move(data.held_back);
    validation_ = std::move(data.validation);
    repeated_ = std::move(data.repeated);
    orientation_ = data.orientation;
    if (!data.images.empty()) judge_platform(data.images);
  }

  /// With frames of its own for every campaign if there are several.
  std::unique_ptr<IdentificationModel> model_of(const Problem& problem) const {
    auto model = make_model({problem, spec_});
    return campaigns_.empty()
               ? std::move(model)
               : with_campaigns(std::move(model), campaigns_, moved_frames(problem_.measurement, options_.moved));
  }

  /// First fit of base and tool alone. Loads then bend the robot as it stands there; how little
  /// that moves it is found by place_again().
  void place(const VariantColumns& all, FitOptions& fit_options) {
    placed_ = placed_campaigns(*model_, all, fitted_, campaigns_, fit_options);
    take_canonical_angles(*model_, all, placed_);
    fit_options.start = placed_;
    model_->take_loads_at(placed_);
  }

  /// Where base, tool and targets are, and what the readings determine there.
  void choose_and_place(const VariantColumns& all, FitOptions& fit_options) {
    place(all, fit_options);
    choose_columns(all);
    leave_at_nominal_values(all, fit_options.start);
    fit_options.limits = frame_limits(*model_, columns_, result_.prior, placed_);
    place_again(fit_options);
  }

  /// Reference of the estimate: columns of base, tool and targets alone.
  void place_again(const FitOptions& fit_options) {
    const VariantColumns place = placing_columns(columns_);
    placed_ = fit_options.start;
    if (!place.selected.empty()) placed_ = fit(*model_, place, fitted_, fit_options).correction;
  }

  void judge_platform(const std::vector<PlatformImage>& images) {
    const PlatformPoints points = *platform_points(problem_.robot, problem_.measurement, *model_);
    std::vector<Eigen::Vector3d> places;
    for (const TargetSpec& target : points.body) places.push_back(target.position);
    try {
      result_.platform = platform_deformation(places, images, points.noise);
    } catch (const CannotDo& error) {
      result_.notes.push_back(std::string("the platform's deformation is not analysed: ") + error.what());
    }
  }

  void report(double done) const { monitor_.report({"calibration", done, 2, {}, {}, {}}); }

  void choose_columns(const VariantColumns& all) {
    result_.automatic = all.automatic;
    if (all.automatic)
      for (int i = 0; i < int(model_->parameters().size()); ++i)
        if (std::find(all.selected.begin(), all.selected.end(), i) == all.selected.end())
          result_.not_in_auto.push_back(model_->parameters()[std::size_t(i)].name);
    ChosenColumns chosen = chosen_columns(*model_, all, fitted_, placed_, result_.prior);
    columns_ = std::move(chosen.columns);
    left_out_ = std::move(chosen.left_out);
    given_ = std::move(chosen.given);
    note(given_.note(left_out_));
    if (columns_.selected.empty()) throw CannotDo("the data determine no parameter of variant '" + spec_.name + "'");
  }

  /// Parameters that are not estimated get their nominal value, even after the placing fit.
  void leave_at_nominal_values(const VariantColumns& all, std::vector<double>& start) const {
    for (const int i : all.selected)
      if (std::find(columns_.selected.begin(), columns_.selected.end(), i) == columns_.selected.end())
        start[std::size_t(i)] = 0.0;
  }

  void note(std::string text) {
    if (!text.empty()) result_.notes.push_back(std::move(text));
  }

  /// An effect that most of the residuals are moves estimates farther than their intervals reach; a smaller one counts
  /// where it moves them many times as far.
  void give_effect() {
    const std::vector<ScoreTest>& effects = result_.effects;
    const auto most = std::ranges::find_if(effects, &ScoreTest::dominates);
    const auto effect = most != effects.end() ? most : effects.begin();
    if (effect != effects.end() && effect->beyond_chance())
      note(given_.take(*effect, columns_.parameters, result_.fit.covariance,
                       stretch() * (effect->dominates() ? 1.0 : far_moved)));
  }

  /// For a variant with an unmodelled effect the fit once more, counting it.
  void allow_for_unmodelled(FitOptions& options) {
    const auto effect = effect_to_count({problem_, spec_}, poses(), result_);
    if (effect == nullptr) return;
    options.effect = effect;
    options.start = result_.fit.correction;
    result_.fit = fit(*model_, columns_, fitted_, options);
  }

  /// Poses of another day may have been read in another frame: their errors are then those of the frame.
  void judge_frame() {
    if (validation_.empty() || !result_.fit.converged) return;
    const std::optional<FrameShift> shift = frame_shift(*model_, validation_, result_.correction);
    if (!shift || !shift->is_another_frame()) return;
    result_.notes.push_back(
        fmt::format("{}: check its frame. With the base moved by {} and {}, its residuals fall from {:.3g} to {:.3g} "
                    "times the stated noise",
                    options_.validate.string(), shown_value(shift->moved, "m"), shown_value(shift->turned, "rad"),
                    shift->before, shift->after));
  }

  /// True if residuals are larger than the noise allows; then σ follow the residuals.
  void judge_noise() {
    const Fit& fit = result_.fit;
    if (!repeated_.empty()) {
      result_.lack_of_fit =
          lack_of_fit(*model_, *model_of(without_pose_errors(problem_)), problem_.measurement, fitted_, repeated_, fit);
    }
  }

  /// A fit that counts an effect leaves readings by more than its estimate: their χ² has another mean then.
  void judge_instruments(const FitOptions& options) {
    result_.instruments = instrument_residuals(*model_, columns_, fitted_, result_.fit);
    if (result_.counted)
      for (InstrumentResiduals& one : result_.instruments) one.test = {};
    judge_help(*model_, columns_, fitted_, options, result_.fit, result_.left_out, monitor_, result_.instruments);
    note(note_of_instruments(result_.instruments));
  }

  void fill_parameters() {
    give_effect();
    std::erase_if(result_.orientations, [this](const CalibratedOrientation& o) { return given_.turn(o.frame); });
    std::vector<CalibratedParameter> nuisance;
    for (std::size_t j = 0; j < columns_.parameters.size(); ++j) {
      const auto k = Eigen::Index(j);
      CalibratedParameter p;
      p.label = columns_.parameters[j];
      p.value = p.label.nominal + result_.fit.change[k];
      p.prior = counts(p.label, result_.prior);
      p.spread = result_.fit.spreads[std::size_t(columns_.selected[j])];
      p.sigma = std::sqrt(result_.fit.covariance(k, k));
      p.half_width = stretch() * p.sigma;
      p.lower = p.value - p.half_width;
      p.upper = p.value + p.half_width;
      if (const ProfileInterval* profile = profiled_.of(int(j))) {
        p.profiled = true;
        p.lower = p.label.nominal + profile->lower;
        p.upper = p.label.nominal + profile->upper;
      }
      p.weak = p.sigma > p.label.tolerance * (p.prior ? prior_share * p.spread : 1.0);
      given_.mark(p);
      (p.label.role == Role::nuisance ? nuisance : result_.parameters).push_back(std::move(p));
    }
    for (const int j : result_.fit.contradicted)
      result_.notes.push_back("the readings contradict the stated tolerance of " +
                              columns_.parameters[std::size_t(j)].name + ": the stated value is kept");
    // Bases of other campaigns are the instrument's, and none of the robot's values.
    const auto robot = make_model({problem_, spec_});
    const std::vector<double> own(result_.correction.begin(),
                                  result_.correction.begin() + std::ptrdiff_t(robot->parameters().size()));
    std::vector<CalibratedValue> values = calibrated_values({problem_, spec_}, *robot, own);
    result_.frames = placed_frames({problem_, spec_}, values);
    add_campaign_frames(*robot);
    // One that is nominal is half of what another one's place means: readings are in the axes of a station.
    if (std::ranges::none_of(result_.frames, [this](const PlacedFrame& frame) { return is_estimated(frame); }))
      result_.frames.clear();
    for (CalibratedValue& value : values) result_.values.push_back({std::move(value), {}});
    for (std::size_t j = 0; j < columns_.selected.size(); ++j)
      if (columns_.selected[j] < int(result_.values.size()) && !given_.contains(columns_.parameters[j].name))
        result_.values[std::size_t(columns_.selected[j])].sigma =
            std::sqrt(result_.fit.covariance(Eigen::Index(j), Eigen::Index(j)));
    for (const Parameter& p : columns_.parameters) result_.columns.push_back(p.name);
    for (auto* more : {&nuisance, &left_out_})
      result_.parameters.insert(result_.parameters.end(), more->begin(), more->end());
  }

  /// Place of the moved frame in each further campaign.
  void add_campaign_frames(const IdentificationModel& robot) {
    const std::vector<std::string> moved = moved_frames(problem_.measurement, options_.moved);
    for (std::size_t c = 1; c < campaigns_.size(); ++c) {
      std::vector<double> there = correction_in(*model_, campaigns_[c], result_.correction);
      there.resize(robot.parameters().size());
      for (PlacedFrame& frame : placed_frames({problem_, spec_}, calibrated_values({problem_, spec_}, robot, there))) {
        if (std::ranges::count(moved, frame.name) == 0) continue;
        frame.name = name_in(campaigns_[c], frame.name);
        result_.frames.push_back(std::move(frame));
      }
    }
  }

  bool is_estimated(const PlacedFrame& frame) const {
    return std::ranges::any_of(columns_.parameters,
                               [&](const Parameter& p) { return p.name.starts_with(frame.name + "."); });
  }

  /// Base and tool, geometry, stiffness one after the other, beside the joint estimate.
  void identify_in_steps(FitOptions options) {
    options.start = placed_;
    try {
      result_.in_steps = fit_in_steps(*model_, columns_, fitted_, options, result_.fit);
      for (std::size_t j = 0; j < columns_.parameters.size(); ++j)
        for (CalibratedParameter& p : result_.parameters)
          if (p.estimated && p.label.name == columns_.parameters[j].name)
            p.in_steps = p.label.nominal + result_.in_steps->correction[std::size_t(columns_.selected[j])];
    } catch (const CannotDo& error) {
      result_.notes.push_back(std::string("identification in steps is not possible: ") + error.what());
    }
  }

  Problem problem_;
  const CalibrateOptions& options_;
  const Monitor& monitor_;
  const VariantSpec& spec_;
  std::vector<std::string> campaigns_;  ///< none: one file
  std::unique_ptr<IdentificationModel> model_;
  VariantColumns columns_;
  std::vector<MeasuredPose> fitted_, held_back_, validation_;
  std::vector<CalibratedParameter> left_out_;
  GivenParameters given_;
  std::vector<double> placed_;
  ProfiledColumns profiled_;
  std::optional<VisitErrors> contradicted_visits_;  ///< where the stated repeatability does not give the readings
  std::vector<RepeatedReadings> repeated_;
  OrientationForm orientation_{};
  Calibration result_;
};

}  // namespace

Calibration calibrate_problem(const Problem& problem, const CalibrateOptions& options, const Monitor& monitor) {
  if (options.campaigns.empty() || options.moved != Moved::automatic)
    return CalibrationRun(problem, options, monitor).run();
  CalibrateOptions chosen = options;
  chosen.moved = Moved::base;
  const bool tool = is_tool_remounted(problem, chosen, monitor);
  if (tool) chosen.moved = Moved::both;
  Calibration result = CalibrationRun(problem, chosen, monitor).run();
  if (tool)
    result.notes.push_back(
        "residuals fall beyond chance with a tool of its own for each file (remounted between?): it is estimated; "
        "--moved base shares one");
  return result;
}

}  // namespace posewright
