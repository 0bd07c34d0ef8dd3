// The certificate over the whole workspace, where it is proved. Second roads: grids of candidates finer than any plan
// needs, and sensitivities at random configurations by the model alone.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "posewright/outputs/write_plan.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/planar_arm.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

class WorkspaceProofs : public testing::Test {
 protected:
  Problem arm(const std::string& more = "", const std::string& parameters = "q1.offset, q2.offset, tool.x") {
    folder_.write("arm.urdf", planar_arm_urdf);
    return read_problem(folder_.write(
        "p.yaml",
        "posewright: 1\nrobot: {urdf: arm.urdf}\nmeasurement: {type: pose, components: [x, y], device: {type: "
        "isotropic, "
        "noise: {position: 0.1 mm, rotation: 1 deg}}" +
            more + "}\nvariants:\n  only: {parameters: [" + parameters +
            "]}\nworkspace: {joints: {margin: 0 deg}}\ndesign: {variant: only, poses: 6, candidates: 300}\n"));
  }
  TemporaryFolder folder_;
};

TEST_F(WorkspaceProofs, NoGridOfCandidatesHasAPlanBeyondTheBound) {
  const Problem problem = arm();
  const Plan plan = plan_problem(problem, {}, Monitor{});
  ASSERT_TRUE(plan.certificate.workspace && plan.certificate.workspace->proved) << plan.certificate.workspace->why_not;
  std::vector<std::vector<double>> grid;
  for (int i = 0; i <= 60; ++i)
    for (int j = 0; j <= 60; ++j) grid.push_back({-2 + i / 15.0, -2 + j / 15.0});
  PlanOptions options;
  options.candidates_from = given_poses(problem, grid);
  options.repeats = Repeats{Repeats::any_number};
  const Plan on_grid = plan_problem(problem, options, Monitor{});
  // What is the best on the grid is below what no plan exceeds; and the proof wastes no more than it says.
  EXPECT_LE(on_grid.certificate.bound, plan.certificate.workspace->bound + 1e-9);
  EXPECT_GT(on_grid.certificate.bound, plan.certificate.workspace->bound - 0.01 * 3);
  EXPECT_LE(plan.log_det, plan.certificate.workspace->bound);
  EXPECT_THAT(plan_summary(plan), HasSubstr("Proved over the joint limits"));
}

TEST_F(WorkspaceProofs, WhatIsNoPolynomialIsSearchedAndSaidToBe) {
  const auto why = [&](const Problem& problem) {
    PlanOptions options;
    options.candidates = 200;
    const Plan plan = plan_problem(problem, options, Monitor{});
    EXPECT_FALSE(plan.certificate.workspace->proved);
    EXPECT_THAT(plan_summary(plan), HasSubstr("no proof: "));
    return plan.certificate.workspace->why_not;
  };
  // A gear's column grows with the angle itself; a turn of each visit moves the tip by what it points at.
  EXPECT_THAT(why(arm("", "q1.offset, q2.offset, q1.gear")), HasSubstr("not linear in cosines and sines"));
  EXPECT_THAT(why(arm(", repeatability: {position: 0.1 mm, rotation: 0.01 deg}")), HasSubstr("not linear"));
  EXPECT_THAT(why(example("instruments/tracker_two_stations.yaml")), HasSubstr("a choice of station"));
}

TEST_F(WorkspaceProofs, PlanIsTheSameOnAnyNumberOfThreads) {
  const Problem problem = arm();
  const auto text = [&](int threads) {
    PlanOptions options;
    options.threads = threads;
    Plan plan = plan_problem(problem, options, Monitor{});
    plan.statistics.seconds = 0;
    for (PlanStage& stage : plan.statistics.stages) stage.seconds = 0;
    return plan_json(plan);
  };
  EXPECT_EQ(text(1), text(3));
}

}  // namespace
}  // namespace posewright
