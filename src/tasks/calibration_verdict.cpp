#include "calibration_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/calibration/frame_limits.hpp"
#include "posewright/calibration/gross_errors.hpp"
#include "posewright/outputs/table.hpp"

namespace posewright {
namespace {

// Share of a step of one σ that the linear model misses: beyond it σ means nothing.
constexpr double hopeless_curvature = 10.0;

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
  ResidualSize size = residual_size(poses.model, with_usual_tolerances(poses), poses.fitted, c.fit.correction);
  size.found = c.fit.scale;  // counts the parameters
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

std::string predicted(const Calibration& c) {
  return fmt::format("errors at new poses: {:.3g} times the stated noise with the estimate, {:.3g} times uncalibrated",
                     c.left_out.estimated, c.left_out.placed);
}

}  // namespace

void judge_calibration(const CalibratedPoses& poses, Calibration& c) {
  if (!c.fit.converged) {
    c.refusals.push_back(not_converged(c));
  } else {
    refuse_residuals(poses, c);
    refuse_few_poses(c);
    refuse_open_frames(poses, c);
    if (c.left_out.worse() && std::isfinite(c.left_out.estimated))
      c.refusals.push_back(predicted(c) + ", a significant gain" + near_dependence(c) + "; " + remedy_of(c));
  }
  c.verdict = !c.refusals.empty()                            ? Verdict::do_not_use
              : c.left_out.groups > 0 && !c.left_out.gains() ? Verdict::gain_not_shown
                                                             : Verdict::use_it;
  if (c.verdict == Verdict::gain_not_shown)
    c.notes.push_back("gain not shown: " + predicted(c) +
                      ", not significant: the data do not show that these parameters are better than the nominal ones" +
                      near_dependence(c));
}

}  // namespace posewright
