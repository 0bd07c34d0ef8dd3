#include "calibration_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/calibration/frame_limits.hpp"
#include "posewright/calibration/gain_in_range.hpp"
#include "posewright/calibration/gross_errors.hpp"
#include "posewright/calibration/placing_columns.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

// Share of a step of one σ that the linear model misses: beyond it σ means nothing.
constexpr double hopeless_curvature = 10.0;
// Predictions whose σ is so many times what base and tool alone leave are worse than these.
constexpr double hopeless_predictions = 3.0;
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

void refuse_residuals(const CalibratedPoses& poses, Calibration& c) {
  // The scale counts the parameters.
  const ResidualSize size{c.fit.scale,
                          explained_rms(poses.model, with_usual_tolerances(poses), poses.fitted, c.fit.correction)};
  if (!size.beyond_robots()) return;
  c.refusals.push_back(
      fmt::format("residuals are {:.3g} times the stated noise; noise and tolerances explain {:.3g} times. Check "
                  "units, signs and zeros of the joints, and the order of rows, targets and angles",
                  size.found, size.explained));
}

/// An estimate that nothing can test.
void refuse_few_poses(Calibration& c) {
  if (c.poses < 2) c.refusals.emplace_back("only one pose was measured: no other pose can check the estimate");
  else if (c.left_out.groups > 0 && !std::isfinite(c.left_out.estimated))
    c.refusals.push_back("too few poses to leave one out: " + c.left_out.why_not + near_dependence(c) + "; " +
                         remedy_of(c));
}

/// A frame that the readings leave open may be metres off, wherever the weak limits hold it.
void refuse_open_frames(const CalibratedPoses& poses, Calibration& c) {
  if (const auto loose = loose_direction(poses.columns, c.prior, c.fit, size_of(poses.model)))
    c.refusals.push_back(fmt::format(
        "the readings determine the position of frames along {} only to {} (1σ), more than the size of the robot; {}",
        loose->text(), shown_value(loose->sigma, loose->unit), remedy_of(c)));
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
  const double left =
      residual_rms(poses.model, poses.fitted, poses.placed) * std::sqrt(1 + placing_variance(poses, at));
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
         ", not significant: the data do not show that these parameters are better than the nominal ones" +
         near_dependence(c);
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
      c.refusals.push_back(predicted(c) + ", a significant gain" + near_dependence(c) + "; " + remedy_of(c));
  }
  const bool shown = c.left_out.groups == 0 || (c.left_out.gains() && c.left_out.gains_in_range());
  c.verdict = !c.refusals.empty() ? Verdict::do_not_use : shown ? Verdict::use_it : Verdict::gain_not_shown;
  if (c.verdict == Verdict::gain_not_shown) c.notes.push_back("gain not shown: " + why_not_shown(c));
}

}  // namespace posewright
