// Sentences of results against the figures that they are said of: direction, size, number.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "posewright/results/calibration.hpp"
#include "posewright/results/compensation.hpp"
#include "posewright/results/next.hpp"
#include "posewright/tasks/model_choice.hpp"

namespace posewright {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Calibration empty_calibration() {
  Calibration c;
  c.tests.histogram.assign(18, 0);
  c.smooth.why_not = "not asked";
  return c;
}

/// With χ² of 100 degrees of freedom, the fit's own, and the test's where the fit counts an effect.
std::string chi_square_sentence(double of_test, double of_fit, double probability, double noise_factor) {
  Calibration c = empty_calibration();
  c.tests.chi_square = {of_test, probability, true};
  c.fit.chi_square = of_fit;
  c.fit.freedom = 100;
  c.fit.scale = std::sqrt(of_fit / 100);
  c.fit.noise_factor = noise_factor;
  return calibration_text(c);
}

TEST(Sentences, OfChiSquareSayWhichFitAndWhichDirection) {
  EXPECT_THAT(chi_square_sentence(100, 100, 0.5, 1), HasSubstr("residuals are 1 times the stated noise, as expected."));
  EXPECT_THAT(chi_square_sentence(49, 49, 1e-5, 1), HasSubstr("0.7 times the stated noise.\n  The noise is smaller"));
  EXPECT_THAT(chi_square_sentence(225, 225, 1e-9, 1.5),
              AllOf(HasSubstr("1.5 times the stated noise.\n  The chi-square test rejects model or noise; σ and "
                              "intervals are scaled by 1.5.")));
  // Tolerances were exceeded, not the noise.
  EXPECT_THAT(chi_square_sentence(225, 225, 1e-9, 1),
              AllOf(HasSubstr("keep to the stated noise"), Not(HasSubstr("smaller"))));
  // An effect that counts takes the excess up: the test is of the fit without it.
  EXPECT_THAT(
      chi_square_sentence(225, 100, 1e-9, 1),
      AllOf(HasSubstr("before an effect is counted: residuals are 1.5 times the stated noise"),
            HasSubstr("With the effect they are 1 times; σ and intervals count it.\n"), Not(HasSubstr("smaller"))));
  EXPECT_THAT(chi_square_sentence(400, 225, 1e-9, 1.5),
              HasSubstr("1.5 times; σ and intervals count it, and are scaled by 1.5"));
}

TEST(Sentences, OfATolerancesShareNeedOneThatCounts) {
  Calibration c = empty_calibration();
  CalibratedParameter p;
  p.label.name = "joint_1.offset";
  p.label.unit = "rad";
  p.label.tolerance = p.sigma = 1e-3;
  p.weak = p.prior = true;
  c.parameters = {p};
  EXPECT_THAT(calibration_text(c), HasSubstr("determined mostly by its tolerance"));
  c.parameters[0].prior = false;
  EXPECT_THAT(calibration_text(c),
              AllOf(HasSubstr("free"), HasSubstr("σ exceeds its tolerance"), Not(HasSubstr("mostly"))));
  c.automatic = true;
  p.estimated = false;
  c.parameters.push_back(p);
  EXPECT_THAT(calibration_text(c),
              HasSubstr("1 more parameter of the robot is a combination of these or without effect"));
  c.parameters.push_back(p);
  EXPECT_THAT(calibration_text(c),
              HasSubstr("2 more parameters of the robot are combinations of these or without effect"));
}

TEST(Sentences, OfCorrelationsHaveItsSign) {
  Calibration c = empty_calibration();
  c.tests.serial = c.tests.within = {0.3, 1e-4, true};
  EXPECT_THAT(calibration_text(c), AllOf(HasSubstr("drift, temperature"), HasSubstr("State a larger repeatability")));
  c.tests.serial = c.tests.within = {-0.3, 1e-4, true};
  EXPECT_THAT(calibration_text(c), AllOf(HasSubstr("residuals alternate"), HasSubstr("stated too large"),
                                         Not(HasSubstr("drift")), Not(HasSubstr("larger repeatability"))));
}

TEST(Sentences, OfASmoothEffectSayWhichSizeCounts) {
  Calibration c = empty_calibration();
  c.smooth.why_not.clear();
  c.smooth.probability = 1e-4;
  c.smooth.size = 3e-4;
  c.smooth.noise = 1.5;
  EXPECT_THAT(calibration_text(c), HasSubstr("with `unmodelled: auto` of a variant σ include it"));
  c.counted = {2e-4, 1.0};  // noise that is refused counts beside it
  EXPECT_THAT(calibration_text(c), HasSubstr("; σ and intervals include it."));
  c.counted->size = 1e-4;
  EXPECT_THAT(calibration_text(c), HasSubstr("; σ and intervals include the stated 0.1 mm."));
}

TEST(Sentences, OfInterpolationCallALossBeyondChanceNoAccident) {
  Calibration c = empty_calibration();
  c.interpolation.emplace();
  c.interpolation->unit = "m";
  const auto said = [&](double gain) {
    c.interpolation->gain = gain;
    return calibration_text(c);
  };
  EXPECT_THAT(said(5), AllOf(HasSubstr("a gain (5.0 standard errors)."), Not(HasSubstr("parameters alone."))));
  EXPECT_THAT(said(1), HasSubstr("a gain (1.0 standard errors), not significant"));
  EXPECT_THAT(said(-1), HasSubstr("a loss (1.0 standard errors), not significant"));
  EXPECT_THAT(said(-5), HasSubstr("a loss (5.0 standard errors): predictions use the parameters alone"));
}

TEST(Sentences, OfNextPosesSayLowerOnlyOfWhatIsLower) {
  NextPoses r;
  r.verdict = NextVerdict::go_on;
  r.measured = 6;
  r.curve.push_back({6, 1e-3});
  r.ahead.push_back({7, 0.5e-3});
  EXPECT_THAT(next_reason(r), HasSubstr(" Pose 7 lowers it from 1 mm to 0.5 mm."));
  r.ahead.push_back({8, 2e-3});
  EXPECT_THAT(next_reason(r), HasSubstr(" Poses 7 and 8 bring it from 1 mm to 2 mm."));
  NextPoses none;
  none.smallest = none.parameters = 1;
  EXPECT_THAT(next_reason(none), HasSubstr("At least 1 pose determines all 1 parameters"));
}

TEST(Sentences, OfNoModelToRecommendSayWhetherOneGains) {
  std::vector<Calibration> models(2);
  models[0].left_out.groups = models[1].left_out.groups = 10;
  models[0].verdict = models[1].verdict = Verdict::gain_not_shown;
  EXPECT_THAT(choose_model(models).why, HasSubstr("none is shown to predict new poses better"));
  models[1].left_out.gain = 5;
  models[1].verdict = Verdict::do_not_use;
  EXPECT_THAT(choose_model(models).why,
              HasSubstr("none that predicts new poses better than the uncalibrated robot is fit"));
}

TEST(Sentences, OfALineThatCannotBeFollowedGiveNoLength) {
  Compensation c;
  c.lines.push_back({"a.src", 3, 1e-3});
  EXPECT_THAT(compensation_text(c),
              HasSubstr("1 straight motion between poses: the tool leaves the line by up to 1.000000 mm (a.src:3)"));
  c.lines.push_back({"a.src", 5, std::numeric_limits<double>::infinity()});
  EXPECT_THAT(compensation_text(c),
              AllOf(HasSubstr("the tool cannot follow the line (a.src:5)"), Not(HasSubstr("inf"))));
}

}  // namespace
}  // namespace posewright
