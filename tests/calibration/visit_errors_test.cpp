// Targets that err together at a visit: how much the readings show beyond what is stated, and that noise alone is none.

#include "posewright/calibration/visit_errors.hpp"

#include <gmock/gmock.h>

#include "posewright/problem/read_problem.hpp"
#include "tests/kit/urdf_text.hpp"
#include "tests/kit/virtual_file.hpp"

namespace posewright {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class Visits : public testing::Test {
 protected:
  Visits() {
    folder_.write("robot.urdf", urdf_text({{'R', "0 0 0.3", "0 0 0", "0 0 1"},
                                           {'R', "0.1 0 0.2", "0 0 0", "0 1 0"},
                                           {'R', "0 0 0.5", "0 0 0", "0 1 0"},
                                           {'R', "0.2 0 0.1", "0 0 0", "1 0 0"},
                                           {'R', "0.35 0 0", "0 0 0", "0 1 0"},
                                           {'R', "0.1 0 0", "0 0 0", "1 0 0"}}));
  }

  Problem problem(const std::string& repeatability) {
    return read_problem(folder_.write("problem.yaml", R"(posewright: 1
robot: {urdf: robot.urdf}
measurement:
  type: points
  targets: {)" + targets_ + R"(}
  device: {type: isotropic, noise: "4 um"}
)" + repeatability + R"(
variants: {geometric: {parameters: auto, nuisance: ["base.*", "target.*"]}}
design: {poses: 20, candidates: 500}
)"));
  }

  /// Readings of a robot that is off by tolerances, times `noise` of the model's.
  void read(const IdentificationModel& model, const Problem& told, double noise, std::uint64_t seed) {
    Random random(seed, 0);
    const VariantColumns columns = select_columns(model, {told, told.variants.front()});
    truth_ = random_truth(model, columns, 0.5, random);
    poses_ = random_poses(model, 20, random);
    read_poses_of(model, truth_, noise, random, poses_);
    options_.data = folder_.write("data.csv", measured_data_csv(model, poses_));
    new_poses_ = random_poses(model, 60, random);
  }

  /// Squared errors of what is predicted at poses that were not measured.
  double squares(const IdentificationModel& model, const std::vector<double>& correction) const {
    double sum = 0;
    Eigen::VectorXd y, right;
    for (const MeasuredPose& pose : new_poses_) {
      model.predict(pose.q, correction, y);
      model.predict(pose.q, truth_, right);
      sum += (y - right).squaredNorm();
    }
    return sum;
  }

  TemporaryFolder folder_;
  std::string targets_ = "A: [0.06, 0.01, 0.03], B: [-0.04, 0.07, 0.05], C: [0.01, -0.06, 0.09]";
  std::vector<double> truth_;
  std::vector<MeasuredPose> poses_, new_poses_;
  CalibrateOptions options_;
};

TEST_F(Visits, WhatOfThemIsStatedHardlyChangesTheEstimate) {
  const Problem told = problem("  repeatability: {position: \"0.3 mm\", rotation: \"0.4 mrad\"}");
  const auto model = make_model({told, told.variants.front()});
  double best = 0;
  std::array<double, 3> found{};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    read(*model, told, 1.0, seed);
    const Calibration c = calibrate_problem(told, options_, Monitor{});
    EXPECT_THAT(c.notes, Not(Contains(HasSubstr("err together"))));
    best += squares(*model, c.correction);
    std::size_t k = 0;
    for (const char* said :
         {"", "  repeatability: \"0.3 mm\"", "  repeatability: {position: 0, rotation: \"0.4 mrad\"}"}) {
      const Calibration other = calibrate_problem(problem(said), options_, Monitor{});
      EXPECT_THAT(other.notes, Contains(HasSubstr("targets of a pose err together: counted"))) << said;
      found[k++] += squares(*model, other.correction);
    }
  }
  for (const double sum : found) EXPECT_LT(std::sqrt(sum / best), 1.1);
}

TEST_F(Visits, AreAsLargeAsTheyWereDrawn) {
  const Problem told = problem("  repeatability: {position: \"0.3 mm\", rotation: \"0.4 mrad\"}"), silent = problem("");
  const auto drawn = make_model({told, told.variants.front()}), model = make_model({silent, silent.variants.front()});
  read(*drawn, told, 1.0, 7);
  const VariantColumns columns = select_columns(*model, {silent, silent.variants.front()});
  VariantColumns offsets;
  for (std::size_t j = 0; j < columns.selected.size(); ++j)
    if (columns.parameters[j].role == Role::nuisance || columns.parameters[j].name.ends_with(".offset")) {
      offsets.selected.push_back(columns.selected[j]);
      offsets.parameters.push_back(columns.parameters[j]);
    }
  FitOptions options;
  options.prior = Prior::manufactured;
  options.start = truth_;
  const Fit f = fit(*model, offsets, poses_, options);
  const VisitErrors found = visit_errors(*model, {}, offsets, poses_, f, options.prior);
  EXPECT_TRUE(found.shown());
  // Of 60 displacements and 60 rotations, less what 21 parameters take up: three times the spread of such an estimate.
  EXPECT_NEAR(found.translation, 0.3e-3, 0.08e-3);
  EXPECT_NEAR(found.rotation, 0.4e-3, 0.13e-3);
}

TEST_F(Visits, AreNotSeenInNoiseThatIsLargerThanStated) {
  const Problem silent = problem("");
  const auto model = make_model({silent, silent.variants.front()});
  int shown = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    read(*model, silent, 3.0, seed);
    const Calibration c = calibrate_problem(silent, options_, Monitor{});
    EXPECT_NEAR(c.fit.noise_factor, 3.0, 0.6);
    shown +=
        std::ranges::any_of(c.notes, [](const std::string& n) { return n.find("err together") != n.npos; }) ? 1 : 0;
  }
  EXPECT_LE(shown, 1);
}

TEST_F(Visits, ThatAreStatedTooSmallAreNamedAndKept) {
  const Problem told = problem("  repeatability: {position: \"0.3 mm\", rotation: \"0.4 mrad\"}");
  read(*make_model({told, told.variants.front()}), told, 1.0, 3);
  const Calibration c = calibrate_problem(problem("  repeatability: {position: \"0.03 mm\", rotation: \"0.4 mrad\"}"),
                                          options_, Monitor{});
  EXPECT_FALSE(c.visits);
  EXPECT_THAT(c.notes, Contains(HasSubstr("the readings contradict the stated repeatability")));
  for (const std::string& note : c.notes)
    if (const auto at = note.find("more, about "); at != note.npos) {
      EXPECT_NEAR(std::stod(note.substr(at + 12)), 0.3, 0.06) << note;
    }
  EXPECT_GT(c.fit.noise_factor, 1.5);
  const Calibration right = calibrate_problem(told, options_, Monitor{});
  EXPECT_THAT(right.notes, Not(Contains(HasSubstr("contradict the stated repeatability"))));
}

/// Displacement of a visit and noise are one and the same for a target alone.
TEST_F(Visits, AreNotToldFromNoiseByOneTarget) {
  targets_ = "A: [0.06, 0.01, 0.03]";
  const Problem told = problem("  repeatability: {position: \"0.3 mm\", rotation: \"0.4 mrad\"}"), silent = problem("");
  read(*make_model({told, told.variants.front()}), told, 1.0, 3);
  const auto model = make_model({silent, silent.variants.front()});
  const VariantColumns columns = select_columns(*model, {silent, silent.variants.front()});
  VariantColumns place;
  for (std::size_t j = 0; j < columns.selected.size(); ++j)
    if (columns.parameters[j].name.starts_with("base.")) {
      place.selected.push_back(columns.selected[j]);
      place.parameters.push_back(columns.parameters[j]);
    }
  const Fit f = fit(*model, place, poses_, {});
  ASSERT_GT(f.noise_factor, 10);
  EXPECT_FALSE(visit_errors(*model, {}, place, poses_, f, Prior::none).shown());
  EXPECT_FALSE(calibrate_problem(silent, options_, Monitor{}).visits);
}

}  // namespace
}  // namespace posewright
