#include "calibration_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "posewright/calibration/frame_limits.hpp"
#include "posewright/calibration/gain_in_range.hpp"
#include "posewright/calibration/gross_errors.hpp"
#include "posewright/calibration/placing_columns.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

// Share of a step of one σ that the linear model misses: beyond it σ means nothing.
constexpr double hopeless_curvature = 10.0;
// Predictions whose σ is so many times what base and tool alone leave are worse than these.
constexpr double hopeless_predictions = 3.0;
// σ of a turn of frames in rad beyond which it is open (loose_direction()).
constexpr double largest_angle = 1.0;
// Residuals of a pose, against those of the middle one.
constexpr double stands_out = 3.0;
// Less is no reason to refuse, however significant.
constexpr double worth_a_refusal = 1.02;

std::string remedy_of(const Calibration& c) {
  return std::string("measure more or other poses (plan), fix some of these parameters (`fixed`), or ") +
         (c.prior == Prior::none ? "use tolerances as prior knowledge (without --no-prior)" : "state tolerances");
}

std::string near_dependence(const Calibration& c) {
  return c.weakest.empty() ? "" : ". Nearly inseparable: " + c.weakest;
}

std::string not_converged(const Calibration& c) {
  return c.weakest.empty() ? "the estimate did not converge: check nominal base, tool and units"
                           : "the estimate did not converge" + near_dependence(c) + "; " + remedy_of(c);
}

/// A wide tolerance that was stated for an estimate (1 for a coupling) is no size of what a fit leaves.
VariantColumns with_usual_tolerances(const CalibratedPoses& poses) {
  VariantColumns columns = poses.columns;
  for (std::size_t j = 0; j < columns.selected.size(); ++j) {
    const double usual = poses.model.parameters()[std::size_t(columns.selected[j])].tolerance;
    columns.parameters[j].tolerance = std::min(columns.parameters[j].tolerance, usual);
  }
  return columns;
}

/// ", most at pose 5" where one pose stands out.
std::string worst_pose(const CalibratedPoses& poses, const std::vector<double>& correction) {
  std::vector<double> sizes;
  for (const MeasuredPose& pose : poses.fitted) sizes.push_back(residual_rms(poses.model, {pose}, correction));
  const auto worst = std::ranges::max_element(sizes);
  if (sizes.size() < 3) return "";
  const int id = poses.fitted[std::size_t(worst - sizes.begin())].id;
  const double largest = *worst;
  std::ranges::nth_element(sizes, sizes.begin() + std::ptrdiff_t(sizes.size() / 2));
  return largest > stands_out * sizes[sizes.size() / 2] ? fmt::format(", most at pose {}", id) : "";
}

void refuse_residuals(const CalibratedPoses& poses, Calibration& c) {
  // The scale counts the parameters.
  const ResidualSize size{c.fit.scale, explained_rms(poses.measurement, poses.model, with_usual_tolerances(poses),
                                                     poses.fitted, c.fit.correction)};
  if (!size.unusual()) return;
  const std::string found =
      fmt::format("residuals are {:.3g} times the stated noise{}; noise and tolerances explain {:.3g} times. Check ",
                  size.found, worst_pose(poses, c.fit.correction), size.explained);
  if (size.beyond_robots())
    c.refusals.push_back(found + "units, signs and zeros of the joints, and the order of rows, targets and angles");
  else c.notes.push_back(found + "zeros of the joints and single poses, or estimate more parameters");
}

/// An estimate that nothing can test.
void refuse_few_poses(Calibration& c) {
  if (c.poses < 2) c.refusals.emplace_back("only one pose is fitted: no other pose can check the estimate");
  else if (c.left_out.groups > 0 && !std::isfinite(c.left_out.estimated))
    c.refusals.push_back("poses that are left out cannot be predicted: " + c.left_out.why_not + near_dependence(c) +
                         "; " + remedy_of(c));
}

/// A frame that the readings leave open may be metres off, wherever the weak limits hold it.
void refuse_open_frames(const CalibratedPoses& poses, Calibration& c) {
  if (const auto loose = loose_direction(poses.columns, c.prior, c.fit, size_of(poses.model)))
    c.refusals.push_back(fmt::format(
        "the readings determine the {} of frames along {} only to {} (1σ), more than {}; {}",
        loose->unit == "m" ? "position" : "orientation", loose->text(), shown_value(loose->sigma, loose->unit),
        loose->unit == "m" ? "the size of the robot" : shown_value(largest_angle, "rad"), remedy_of(c)));
  if (c.curvature.largest > hopeless_curvature)
    c.refusals.push_back(
        fmt::format("the problem is strongly nonlinear within one σ (curvature {:.3g}, most along {}): the estimate "
                    "may be anywhere along it{}; {}",
                    c.curvature.largest, poses.columns.parameters[std::size_t(c.curvature.parameter)].name,
                    near_dependence(c), remedy_of(c)));
}

/// Mean square of what base and tool alone predict wrongly at poses, per unit of noise; infinite if they are not
/// determined.
double placing_variance(const CalibratedPoses& poses, const std::vector<MeasuredPose>& at) {
  const VariantColumns place = placing_columns(poses.columns);
  if (place.selected.empty()) return 0.0;
  const Eigen::MatrixXd read = blocks_of(poses.model, place, poses.fitted, poses.placed).all();
  const Eigen::MatrixXd there = blocks_of(poses.model, place, at, poses.placed).all();
  const Eigen::VectorXd scale = read.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(read * scale.asDiagonal());
  if (qr.rank() < read.cols()) return std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd part = (there * scale.asDiagonal() * qr.colsPermutation()).transpose();
  const Eigen::MatrixXd R = qr.matrixR().topRows(read.cols());
  return R.transpose().triangularView<Eigen::Lower>().solve(part).squaredNorm() / double(there.rows());
}

/// Too few poses for so many parameters: their own σ say so.
void refuse_wide_predictions(const CalibratedPoses& poses, Calibration& c) {
  const std::vector<MeasuredPose> at = poses_between(poses.model, poses.fitted, poses.placed);
  if (at.empty()) return;
  const Eigen::MatrixXd J = blocks_of(poses.model, poses.columns, at, poses.placed).all();
  const double sigma = std::sqrt((J * c.fit.covariance).cwiseProduct(J).sum() / double(J.rows()));
  // Readings without noise leave nothing; what the stated noise leaves is the least that errors are compared with.
  const double left =
      std::max(1.0, residual_rms(poses.model, poses.fitted, poses.placed)) * std::sqrt(1 + placing_variance(poses, at));
  if (!(sigma > hopeless_predictions * left)) return;
  c.refusals.push_back(
      fmt::format("between the measured poses the estimate errs by {:.3g} times the stated noise (1σ), base and tool "
                  "alone by {:.3g} times{}; {}",
                  sigma, left, near_dependence(c), remedy_of(c)));
}

std::string predicted(const Calibration& c) {
  return fmt::format("errors at new poses: {:.3g} times the stated noise with the estimate, {:.3g} times uncalibrated",
                     c.left_out.estimated, c.left_out.placed);
}

std::string why_not_shown(const Calibration& c) {
  if (c.left_out.gains())
    return fmt::format(
        "there is one between the measured poses, but over the range of the joints only {:.2g} standard "
        "deviations{}; measure poses all over the range",
        *c.left_out.gain_in_range, near_dependence(c));
  return predicted(c) +
         (c.left_out.worse() ? ", significantly worse, if only a little"
                             : ", not significant: the data do not show that these parameters are better than the "
                               "nominal ones") +
         near_dependence(c);
}

constexpr std::array<const char*, 6> required_axes = {"x", "y", "z", "rx", "ry", "rz"};

using Residuals = std::vector<Eigen::VectorXd>;

void add_axes(const char* which, const std::vector<AxisErrors>& before, const std::vector<AxisErrors>& after,
              std::vector<AxisImprovement>& axes) {
  for (std::size_t a = 0; a < std::min(before.size(), after.size()); ++a) axes.push_back({which, before[a], after[a]});
}

void judge_requirements(const char* which, const RequirementSpec& require, const std::vector<LargestTipError>& errors,
                        std::vector<JudgedRequirement>& requirements) {
  for (const LargestTipError& error : errors) {
    const auto at = std::find(required_axes.begin(), required_axes.end(), error.axis);
    if (const auto& required = require.axes[std::size_t(at - required_axes.begin())])
      requirements.push_back({which, error, *required});
  }
}

void note_unjudged(const RequirementSpec& require, Calibration& result) {
  std::string open;
  for (std::size_t k = 0; k < required_axes.size(); ++k)
    if (require.axes[k] && std::none_of(result.requirements.begin(), result.requirements.end(),
                                        [&](const JudgedRequirement& r) { return r.error.axis == required_axes[k]; }))
      open += (open.empty() ? "" : ", ") + std::string(required_axes[k]);
  if (!open.empty())
    result.notes.push_back("requirement on the tip not checked: " + open +
                           "; the readings of a pose do not determine it");
}

std::vector<double> listed(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

/// @param before  of the fitted poses, then of those held back
/// @param beyond  of those held back, calibrated
void fill_poses(const CalibratedPoses& poses, const Residuals& before, const Residuals& beyond, Calibration& result) {
  for (std::size_t k = 0; k < poses.fitted.size(); ++k) {
    double weight = 1;
    if (!result.fit.weights.empty())
      for (const double w : result.fit.weights[k]) weight = std::min(weight, w);
    result.pose_residuals.push_back(
        {poses.fitted[k].id, false, listed(before[k]), listed(result.fit.residuals[k]), weight});
  }
  const std::vector<PredictedError> predicted =
      predicted_errors(poses.model, poses.columns, poses.held_back, result.fit);
  const std::vector<PoseError> observed = observed_errors(poses.model, beyond);
  for (std::size_t k = 0; k < poses.held_back.size(); ++k)
    result.pose_residuals.push_back({poses.held_back[k].id, true, listed(before[poses.fitted.size() + k]),
                                     listed(beyond[k]), 1.0, PoseAccuracy{predicted[k], observed[k]}});
}

}  // namespace

void judge_calibration(const CalibratedPoses& poses, Calibration& c) {
  if (!c.fit.converged) {
    c.refusals.push_back(not_converged(c));
  } else {
    refuse_residuals(poses, c);
    refuse_few_poses(c);
    refuse_open_frames(poses, c);
    refuse_wide_predictions(poses, c);
    if (c.left_out.worse() && std::isfinite(c.left_out.estimated) &&
        c.left_out.estimated > worth_a_refusal * c.left_out.placed)
      c.refusals.push_back(predicted(c) + ", significantly worse" + near_dependence(c) + "; " + remedy_of(c));
  }
  const bool shown = c.left_out.groups == 0 || (c.left_out.gains() && c.left_out.gains_in_range());
  c.verdict = !c.refusals.empty() ? Verdict::do_not_use : shown ? Verdict::use_it : Verdict::gain_not_shown;
  if (c.verdict == Verdict::gain_not_shown) c.notes.push_back("gain not shown: " + why_not_shown(c));
}

void fill_accuracy(const CalibratedPoses& poses, const RequirementSpec& require, Calibration& result) {
  const IdentificationModel& model = poses.model;
  const std::vector<double> nominal(model.parameters().size(), 0.0);
  const std::size_t placing = placing_columns(poses.columns).selected.size();
  result.placed = placing > 0 && placing < poses.columns.selected.size();
  const bool required =
      std::any_of(require.axes.begin(), require.axes.end(), [](const auto& a) { return a.has_value(); });
  Residuals all_before, beyond;
  for (const std::vector<MeasuredPose>* list : {&poses.fitted, &poses.held_back}) {
    if (list->empty()) continue;
    const char* const which = list == &poses.fitted ? "fitted" : "held back";
    const auto add = [&](const char* parameters, const Residuals& residuals) {
      result.residuals.push_back({which, parameters, summarise(model, *list, residuals)});
    };
    Residuals before = residuals_of(model, nominal, *list);
    add("nominal", before);
    if (result.placed) {
      before = residuals_of(model, poses.placed, *list);
      add("placed", before);
    }
    const Residuals after = residuals_of(model, result.correction, *list);
    add("calibrated", after);
    if (list == &poses.held_back && result.interpolation && result.interpolation->gains())
      add("interpolated", result.interpolation->others);
    add_axes(which, errors_by_axis(model, *list, before), errors_by_axis(model, *list, after), result.axes);
    if (required)
      judge_requirements(which, require, tip_errors(model, *list, result.fit, result.correction, after),
                         result.requirements);
    if (list == &poses.held_back) beyond = after;
    all_before.insert(all_before.end(), before.begin(), before.end());
  }
  note_unjudged(require, result);
  fill_poses(poses, all_before, beyond, result);
}

void fill_compensator(const ElastostaticSpec& spec, Calibration& result) {
  if (!spec.derived_compensator) return;
  const std::string begin = spec.listed->joint.value + ".compliance@";
  ListedCompliances listed;
  listed.at = spec.listed->at;
  std::vector<Eigen::Index> columns;
  std::vector<double> values;
  // The catalogue has them in the order of the list, and so has every selection of its columns.
  for (const EstimatedValue& value : result.values) {
    if (!value.value.name.starts_with(begin)) continue;
    const auto column = std::find(result.columns.begin(), result.columns.end(), value.value.name);
    if (column == result.columns.end()) {
      result.notes.push_back("the compensator's constants need all listed compliances: " + value.value.name +
                             " is not estimated");
      return;
    }
    columns.push_back(column - result.columns.begin());
    values.push_back(value.value.value);
  }
  listed.compliance = Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
  listed.covariance = result.fit.covariance(columns, columns);
  try {
    result.compensator = compensator_from_compliances(*spec.derived_compensator, listed);
  } catch (const CannotDo& error) {
    result.notes.push_back(std::string("no constants of the compensator: ") + error.what());
  }
}

std::string note_of_step(const std::optional<FrameStep>& step) {
  if (!step) return {};
  return fmt::format(
      "from pose {} on, the {} stands elsewhere than up to pose {} ({:.3g} % of the squared residuals, p {}): was {}? "
      "Split the file there and give both parts",
      step->after, step->frame, step->before, 100 * step->share,
      step->chance < 1e-6 ? "below 1e-6" : fmt::format("= {:.2g}", step->chance),
      step->frame == "base" ? "the instrument moved" : "it remounted");
}

std::string note_of_visits(const std::optional<VisitErrors>& visits) {
  if (!visits) return {};
  std::vector<std::string> parts;
  if (visits->translation > 0) parts.push_back("position " + shown_value(visits->translation, "m"));
  if (visits->rotation > 0) parts.push_back("rotation " + shown_value(visits->rotation, "rad"));
  return fmt::format(
      "targets of a pose err together: counted as repeatability, {}; state it, or look for an effect left out",
      fmt::join(parts, ", "));
}

std::string note_of_contradiction(const VisitErrors& visits) {
  return fmt::format(
      "the readings contradict the stated repeatability (p {:.2g}): targets of a pose err together by more, about {} "
      "and "
      "{}; the stated value is kept, and intervals are too small: state what is right",
      visits.contradiction, shown_value(visits.together[0], "m"), shown_value(visits.together[1], "rad"));
}

std::string note_of_instruments(const std::vector<InstrumentResiduals>& instruments) {
  std::vector<std::string> parts;
  for (const InstrumentResiduals& one : instruments) {
    if (one.noise_factor > 1)
      parts.push_back(
          fmt::format("{} counts with {:.3g} times its stated noise, as its residuals are: state it, or look "
                      "for an effect of this instrument",
                      one.name, one.noise_factor));
    if (one.help && one.help->harms())
      parts.push_back(
          fmt::format("with the readings of {0} the other instruments' poses, left out of the estimate, are "
                      "predicted {1:.0f} % worse ({2:.1f} standard errors): leave the rows of {0} out",
                      one.name, 100 * (one.help->with / one.help->without - 1), -one.help->gain));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace posewright
