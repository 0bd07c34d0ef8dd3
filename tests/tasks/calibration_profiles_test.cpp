// Which intervals of a calibration are by profile, and what is said of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include "posewright/results/calibration.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "tests/kit/virtual_file.hpp"

namespace posewright {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// Leg directions of the telescope are not linear within what its readings alone tell of them.
struct Telescope {
  VirtualFile file{"telescope/problem.yaml", 20};
  Telescope() { file.write(); }

  Calibration calibrated(const std::string& profile, const Monitor& monitor = {}, Prior prior = Prior::none) {
    CalibrateOptions options = file.options();
    options.prior = prior;
    options.profile = profile_choice(profile);
    return calibrate_problem(file.problem, options, monitor);
  }
};

std::set<std::string> profiled(const Calibration& c) {
  std::set<std::string> names;
  for (const CalibratedParameter& p : c.parameters)
    if (p.profiled) names.insert(p.label.name);
  return names;
}

TEST(CalibrationProfiles, AreOfTheParametersThatTheCurvatureNames) {
  Telescope telescope;
  const Calibration found = telescope.calibrated("auto");
  ASSERT_GT(found.curvature.largest, curvature_limit);
  const std::set<std::string> names = profiled(found);
  const auto is_direction = [](const std::string& name) { return name.ends_with(".ux") || name.ends_with(".uy"); };
  EXPECT_GE(std::count_if(names.begin(), names.end(), is_direction), 4);
  EXPECT_LT(names.size(), found.parameters.size());
  int differ = 0;
  for (const CalibratedParameter& p : found.parameters) {
    if (!p.profiled) {
      EXPECT_NEAR(p.upper - p.lower, 2 * p.half_width, 1e-9 * p.half_width) << p.label.name;
      continue;
    }
    EXPECT_LT(p.lower, p.value);
    EXPECT_GT(p.upper, p.value);
    differ += std::abs(p.upper - p.value - p.half_width) > 0.1 * p.half_width ? 1 : 0;
  }
  EXPECT_GT(differ, 0);
  const std::string text = calibration_text(found);
  EXPECT_THAT(text, HasSubstr("profile; linear "));
  EXPECT_THAT(text, HasSubstr("Nonlinear within one σ"));
  EXPECT_THAT(text, HasSubstr(std::to_string(names.size()) + " intervals"));
  const auto json = calibration_json(telescope.file.problem, telescope.file.options(), found);
  for (const auto& p : json["parameters"]) {
    EXPECT_EQ(p["interval_by"], names.count(p["name"]) > 0 ? "profile" : "linear");
    if (p["interval_by"] == "linear") {
      EXPECT_EQ(p["interval"], p["linear_interval"]);
    }
  }
  // With their tolerances the directions are linear enough.
  EXPECT_TRUE(profiled(telescope.calibrated("auto", {}, Prior::manufactured)).empty());
}

TEST(CalibrationProfiles, AreOfThoseThatAreNamedOrOfNone) {
  Telescope telescope;
  EXPECT_EQ(profiled(telescope.calibrated("leg_1.l,leg_2.u?")),
            (std::set<std::string>{"leg_1.l", "leg_2.ux", "leg_2.uy"}));
  const Calibration none = telescope.calibrated("none");
  EXPECT_TRUE(profiled(none).empty());
  EXPECT_THAT(calibration_text(none), HasSubstr("intervals are rough"));
  EXPECT_THROW(telescope.calibrated("leg_7.*"), InputError);
  EXPECT_THROW(profile_choice("leg_1.l,"), InputError);
  EXPECT_THROW(profile_choice(""), InputError);
  EXPECT_EQ(profile_choice("all").names, std::vector<std::string>{"*"});
}

TEST(CalibrationProfiles, OfOneThatIsLinearAreTheLinearIntervalsAndFramesHaveNone) {
  VirtualFile arm("kr270/problem.yaml", 20);
  arm.write();
  CalibrateOptions options = arm.options();
  EXPECT_TRUE(profiled(calibrate_problem(arm.problem, options, Monitor{})).empty());
  options.profile = profile_choice("base.*,px1");
  const Calibration found = calibrate_problem(arm.problem, options, Monitor{});
  const std::set<std::string> names = profiled(found);
  EXPECT_EQ(names.count("base.rx"), 0U) << "angles of a frame have no interval of their own";
  EXPECT_EQ(names.count("base.x"), 1U);
  EXPECT_EQ(names.count("px1"), 1U);
  for (const CalibratedParameter& p : found.parameters)
    if (p.profiled) {
      EXPECT_NEAR(p.upper - p.value, p.half_width, 0.02 * p.half_width) << p.label.name;
      EXPECT_NEAR(p.value - p.lower, p.half_width, 0.02 * p.half_width) << p.label.name;
    }
}

TEST(CalibrationProfiles, ThatAreStoppedLeaveLinearIntervalsAndSaySo) {
  Telescope telescope;
  std::atomic<bool> stop{false};
  Monitor monitor;
  monitor.interrupted = &stop;
  monitor.on_progress = [&](const Progress& progress) { stop = stop || progress.stage == "profiles"; };
  const Calibration found = telescope.calibrated("all", monitor);
  EXPECT_TRUE(found.fit.converged);
  const std::size_t done = profiled(found).size();
  EXPECT_GE(done, 1U);
  EXPECT_LE(done, 4U) << "of 42, on at most four threads";
  EXPECT_THAT(found.notes, Contains(HasSubstr("profile intervals are linear")));
  for (const CalibratedParameter& p : found.parameters) {
    EXPECT_TRUE(std::isfinite(p.lower + p.upper) || p.profiled);
  }
}

}  // namespace
}  // namespace posewright
