// Poses that are in a plan before its search: they are still to be measured and count among N.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "posewright/lists/read_poses.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/evaluation.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

constexpr double upper = 1.2, lower = 0.8, noise = 1e-3;  // m

const char* const urdf =
    R"(<robot name="planar"><link name="l0"/><link name="l1"/><link name="l2"/><link name="tip"/>
<joint name="q1" type="revolute"><parent link="l0"/><child link="l1"/><axis xyz="0 0 1"/>
<limit lower="-3" upper="3" effort="0" velocity="1"/></joint>
<joint name="q2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="1.2 0 0"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="0" velocity="1"/></joint>
<joint name="end" type="fixed"><parent link="l2"/><child link="tip"/><origin xyz="0.8 0 0"/></joint></robot>)";

const std::string start =
    "posewright: 1\nrobot: {urdf: planar.urdf}\nmeasurement: {type: points, targets: {T1: [0, 0, 0]}, components: [x, "
    "y], device: {type: isotropic, noise: 1 mm}}\nvariants: {all: {parameters: [q1.offset, q2.offset, q2.x, "
    "target.T1.x]}}\n";

const std::vector<Eigen::Vector2d> candidates = {{0, 1.5},   {0.4, 1.1},  {-2, -1},    {0.3, 0.5},
                                                 {1.5, 0.1}, {2.2, -1.9}, {1, 1.9},    {2.5, -0.4},
                                                 {-1, 0.8},  {-2.4, 1.3}, {0.8, -1.4}, {-0.6, -0.2}};

/// From the definition: derivatives of the point by both zero positions and both lengths.
Eigen::Matrix<double, 2, 4> block(const Eigen::Vector2d& q) {
  const double a = q[0], b = q[0] + q[1];
  const Eigen::Vector2d along(std::cos(a), std::sin(a)), fore(std::cos(b), std::sin(b));
  const auto turned = [](const Eigen::Vector2d& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  Eigen::Matrix<double, 2, 4> J;
  J << turned(upper * along + lower * fore), turned(lower * fore), along, fore;
  return J / noise;
}

double log_det(const std::vector<Eigen::Vector2d>& poses) {
  Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
  for (const Eigen::Vector2d& q : poses) M += block(q).transpose() * block(q);
  return std::log(M.determinant());
}

std::string csv(const std::vector<Eigen::Vector2d>& poses) {
  std::string text = "q1,q2\n";
  for (const Eigen::Vector2d& q : poses) text += fmt::format("{},{}\n", q[0], q[1]);
  return text;
}

class FixedPoses : public testing::Test {
 protected:
  Problem problem(const std::string& design) {
    folder_.write("planar.urdf", urdf);
    folder_.write("list.csv", csv(candidates));
    return read_problem(folder_.write("p.yaml", start + "design: {" + design + "}\n"));
  }
  Plan plan(const std::string& fixed, const std::string& design) {
    folder_.write("fixed.csv", fixed);
    return plan_problem(problem(design + ", fixed: fixed.csv"), {}, Monitor{});
  }
  std::string refusal(const std::string& fixed, const std::string& more = "") {
    return message_of<InputError>([&] { plan(fixed, "criterion: o1, poses: 4, candidates_from: list.csv" + more); },
                                  "accepted");
  }
  TemporaryFolder folder_;
};

TEST_F(FixedPoses, TheRestIsTheBestOfAllWaysToFillThePlan) {
  const std::vector<Eigen::Vector2d> fixed = {{0.2, 0.3}, {0.1, 0.4}};  // a poor beginning, and no candidates
  double best = -INFINITY, free = -INFINITY;
  const std::size_t n = candidates.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k) {
        best = std::max(best, log_det({fixed[0], fixed[1], candidates[i], candidates[j], candidates[k]}));
        for (std::size_t l = k + 1; l < n; ++l)
          for (std::size_t m = l + 1; m < n; ++m)
            free = std::max(free, log_det({candidates[i], candidates[j], candidates[k], candidates[l], candidates[m]}));
      }
  for (const char* method : {"exchange", "branch_and_bound", "auto"}) {
    SCOPED_TRACE(method);
    const Plan found =
        plan(csv(fixed), fmt::format("criterion: o1, poses: 5, candidates_from: list.csv, method: {}", method));
    ASSERT_EQ(found.poses.size(), 5U);
    EXPECT_NEAR(found.log_det, best, 1e-9);
    EXPECT_LT(found.log_det, free - 0.05) << "fixed poses cost something here";
    EXPECT_LE(found.log_det, found.certificate.bound + 1e-9);
    EXPECT_GT(found.certificate.efficiency, 0.8);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(found.poses[i].fixed, i < 2);
      EXPECT_FALSE(found.poses[i].measured);
    }
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(found.poses[i].configuration[k].value, fixed[i][Eigen::Index(k)]);
    // What is left without a pose, fixed or chosen, from the definition.
    for (std::size_t lost = 0; lost < 5; ++lost) {
      std::vector<Eigen::Vector2d> rest;
      for (std::size_t i = 0; i < 5; ++i)
        if (i != lost) rest.emplace_back(found.poses[i].configuration[0].value, found.poses[i].configuration[1].value);
      EXPECT_NEAR(found.poses[lost].without, std::exp((log_det(rest) - found.log_det) / 4), 1e-9) << lost;
    }
  }
}

TEST_F(FixedPoses, PoseThatWasMeasuredBeyondALimitIsAMeasuredOne) {
  const Problem problem = this->problem("criterion: o1, poses: 6, candidates: 60");
  const auto coordinates = pose_coordinates(problem);
  const auto file = folder_.write("measured.csv", csv({{3.0002, 1}}));
  EXPECT_THROW(read_poses(file, coordinates), InputError) << "a pose to go to keeps the limits";
  DesignEdits options;
  options.measured = read_poses(file, without_limits(coordinates));
  const Plan found = planned(problem, options);
  ASSERT_EQ(found.poses.size(), 7U);
  EXPECT_EQ(found.poses[0].configuration[0].value, 3.0002);
  const auto written = folder_.write("plan.json", plan_json(found));
  const PoseListEvaluation judged = evaluate_problem(problem, read_poses(written, coordinates), {}, Monitor{});
  EXPECT_NEAR(judged.plan.log_det, found.log_det, 1e-9);
}

TEST_F(FixedPoses, FiguresOfTheWrittenPlanAreThoseOfEvaluate) {
  const Problem problem = this->problem("criterion: o1, poses: 6, candidates: 60");
  DesignEdits options;
  const auto coordinates = pose_coordinates(problem);
  options.fixed = read_poses(folder_.write("fixed.csv", csv({{0.2, 0.3}, {0.1, 0.4}})), coordinates);
  options.measured = read_poses(folder_.write("measured.csv", csv({{-1, 1}})), coordinates);
  const Plan found = planned(problem, options);
  ASSERT_EQ(found.poses.size(), 7U) << "six, and the measured one";
  EXPECT_TRUE(found.poses[0].measured && found.poses[1].fixed && found.poses[2].fixed && !found.poses[3].fixed);
  const auto file = folder_.write("plan.json", plan_json(found));
  const PoseListEvaluation judged = evaluate_problem(problem, read_poses(file, coordinates), {}, Monitor{});
  EXPECT_NEAR(judged.plan.log_det, found.log_det, 1e-9);
  for (std::size_t j = 0; j < found.parameters.size(); ++j)
    EXPECT_NEAR(*judged.plan.parameters[j].sigma, *found.parameters[j].sigma, 1e-9 * *found.parameters[j].sigma);
  const auto json = parse_json(plan_json(found));
  EXPECT_FALSE(json["poses"][0].contains("fixed"));
  EXPECT_EQ(json["poses"][1]["fixed"], true);
  EXPECT_THAT(plan_summary(found), HasSubstr("6 poses (2 fixed) in addition to 1 measured, for"));
  EXPECT_THAT(plan_summary(found), HasSubstr("any plan of 6 that has the 2 fixed, all others of these"));
  EXPECT_THAT(poses_csv(found), HasSubstr("\n2,0.2,0.3\n")) << "still to be measured";
}

TEST_F(FixedPoses, APoseToDropOrToAddIsCalledAsInTheTable) {
  const Problem problem = this->problem("criterion: o1, poses: 6, candidates: 60, minimum_distance: 40 deg");
  const auto coordinates = pose_coordinates(problem);
  EvaluateOptions options;
  options.run.measured = read_poses(folder_.write("measured.csv", csv({{-1, 1}, {1, 0.5}})), coordinates);
  options.drop = options.add = 1;
  const PoseList list = read_poses(
      folder_.write("list.csv", csv({{0.2, 0.3}, {0.1, 1.4}, {-2, -1}, {1.5, -1.2}, {2.5, 0.7}})), coordinates);
  const PoseListEvaluation e = evaluate_problem(problem, list, options, Monitor{});
  ASSERT_TRUE(e.drop && e.add);
  ASSERT_EQ(e.drop->poses.size(), 1U);
  ASSERT_EQ(e.plan.poses.size(), 7U);
  // Of all poses that may be dropped the one that costs least; what was measured cannot be.
  double most = 0;
  int which = 0;
  for (const PlannedPose& pose : e.plan.poses)
    if (!pose.measured && pose.without > most) {
      most = pose.without;
      which = pose.id;
    }
  EXPECT_EQ(e.drop->poses.front(), which);
  EXPECT_NEAR(e.drop->efficiency, most, 1e-9);
  EXPECT_EQ(e.add->added.front().id, 8);
  EXPECT_THAT(evaluation_text(e), HasSubstr(fmt::format("Drop first: {} (", which)));
  EXPECT_THAT(evaluation_text(e), HasSubstr("Add: 1 pose gives "));
  const auto& rejected = e.plan.statistics.rejected;
  EXPECT_TRUE(
      std::ranges::any_of(rejected, [](const auto& r) { return r.first == "too near to a pose measured already"; }));
}

TEST_F(FixedPoses, OfAMarkedListThoseThatAreMarked) {
  const Plan found =
      plan("pose,q1,q2,fixed\n1,0.2,0.3,no\n2,0.1,0.4,yes\n3,1,1,no\n", "criterion: o1, poses: 4, candidates: 60");
  ASSERT_EQ(found.poses.size(), 4U);
  EXPECT_EQ(std::count_if(found.poses.begin(), found.poses.end(), [](const auto& p) { return p.fixed; }), 1);
  EXPECT_EQ(found.poses[0].configuration[0].value, 0.1);
}

TEST_F(FixedPoses, TheSmallestNumberCountsThem) {
  folder_.write("fixed.csv", csv({{0.2, 0.3}, {0.1, 0.4}, {0.15, 0.2}}));
  const std::string design = "poses: auto, candidates: 60, require: {sigma: {q2.x: 2 mm}}";
  const Plan found = plan_problem(problem(design + ", fixed: fixed.csv"), {}, Monitor{});
  const Plan free = plan_problem(problem(design), {}, Monitor{});
  EXPECT_GE(found.poses.size(), 4U);
  EXPECT_GE(found.poses.size(), free.poses.size());
  EXPECT_TRUE(found.curve.back().enough);
  for (const CurvePoint& point : found.curve) EXPECT_GE(point.poses, 4);
}

TEST_F(FixedPoses, WhatCannotBeFixedIsToldWithFileAndLine) {
  EXPECT_THAT(refusal("q1,q2\n0,1\n0,2.5\n"), HasSubstr("fixed.csv:3: 'q2' is 2.5 rad"));
  EXPECT_THAT(refusal("q1,q2\n0,1\n1,1\n\n0,1\n"), HasSubstr("fixed.csv:5: pose 3 is fixed twice"));
  EXPECT_THAT(refusal("q1,q2\n0,1\n1,1\n2,1\n3,1\n-1,1\n"), HasSubstr("fixed.csv:5: 5 poses are fixed of a plan of 4"));
  EXPECT_THAT(refusal("q1,q2,fixed\n0,1,no\n"), HasSubstr("fixed.csv: fixes no pose"));
  EXPECT_THAT(refusal("q1,q2,fixed\n0,1,perhaps\n"), HasSubstr("fixed.csv:2: 'perhaps' in column 'fixed'"));
  EXPECT_THAT(refusal("q1,q2\n0,1\n", ", reserve: yes"), HasSubstr("reserve and fixed poses cannot be combined"));
  folder_.write("measured.csv", "q1,q2\n0,1\n");
  EXPECT_THAT(refusal("q1,q2\n0,1\n", ", measured: measured.csv"),
              HasSubstr("fixed.csv:2: pose 1 is measured already"));
  EXPECT_EQ(refusal("q1,q2\n0,1\n0,1\n", ", repeats: allow"), "accepted");
}

TEST_F(FixedPoses, APoseThatTheCellForbidsIsRefusedWithTheReason) {
  folder_.write("planar.urdf", urdf);
  folder_.write("fixed.csv", "q1,q2\n1,1\n0.7,-0.2\n");
  const Problem walled = read_problem(
      folder_.write("p.yaml", start + "workspace: {tool: {x: [-3 m, 1.5 m]}}\n" +
                                  "design: {criterion: o1, poses: 4, candidates: 60, fixed: fixed.csv}\n"));
  EXPECT_THAT(message_of<InputError>([&] { plan_problem(walled, {}, Monitor{}); }),
              HasSubstr("fixed.csv:3: pose 2 cannot be fixed: "));
}

TEST_F(FixedPoses, PosesToJudgeByDoNotContainThem) {
  const Problem problem = this->problem("criterion: o1, poses: 5, candidates: 60, fixed: fixed.csv");
  folder_.write("fixed.csv", csv({{0.2, 0.3}}));
  const Plan found = plan_problem(problem, {}, Monitor{});
  const Plan judges = plan_validation(problem, {}, found, 2, Monitor{});
  ASSERT_EQ(judges.poses.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(judges.poses[i].measured, i < 5);
    EXPECT_FALSE(judges.poses[i].fixed);
  }
}

}  // namespace
}  // namespace posewright
