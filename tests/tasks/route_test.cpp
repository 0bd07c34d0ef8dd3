// Routes of an arm with joints of two turns: which turn a pose stands on, and poses in place of lost ones.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/lists/read_poses.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/report/report_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/study/written_plan.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

/// Six axes, each with two turns.
std::string arm_of_two_turns() {
  const char* const offsets[] = {"0 0 0.3", "0.1 0 0.25", "0 0 0.6", "0.2 0 0.1", "0.4 0 0", "0.15 0 0"};
  const char* const axes[] = {"0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"};
  std::string text = "<robot name='arm'><link name='l0'/>";
  for (int k = 0; k < 6; ++k)
    text += fmt::format(
        "<link name='l{1}'><collision><geometry><sphere radius='0.05'/></geometry></collision></link>"
        "<joint name='j{1}' type='revolute'><parent link='l{0}'/><child link='l{1}'/><origin xyz='{2}'/>"
        "<axis xyz='{3}'/><limit lower='-6.3' upper='6.3' velocity='2' effort='1'/></joint>",
        k, k + 1, offsets[k], axes[k]);
  return text + "</robot>";
}

/// Above a floor.
Problem problem_of(const TemporaryFolder& folder, const std::string& parameters) {
  folder.write("arm.urdf", arm_of_two_turns());
  return read_problem(folder.write(
      "p.yaml",
      "posewright: 1\nrobot: {urdf: arm.urdf, base: l0, tip: l6}\n"
      "measurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}\n"
      "workspace: {collision: {self: false, obstacles: [{name: floor, plane: [0, 0, 1], at: [0, 0, -0.4]}]}}\n"
      "variants: {all: {parameters: " +
          parameters + "}}\ndesign: {criterion: o1, poses: 8, candidates: 60, method: greedy, restarts: 1}\n"));
}

RouteOptions from_home(bool replace = false) {
  RouteOptions options;
  options.from_home = true;
  options.replace = replace;
  return options;
}

const PlannedPose* pose_with(const Route& route, int id) {
  const auto at = std::find_if(route.poses.begin(), route.poses.end(), [&](const auto& pose) { return pose.id == id; });
  return at == route.poses.end() ? nullptr : &*at;
}

std::vector<double> values_of(const PlannedPose& pose) {
  std::vector<double> values;
  for (const NamedValue& v : pose.configuration) values.push_back(v.value);
  return values;
}

TEST(Route, TurnsJointsToTheTurnNearestHomeUnlessAParameterGrowsWithTurns) {
  const TemporaryFolder folder;
  const std::vector<std::vector<double>> poses = {{6, 0.3, 0.4, -5, 0.6, 4}, {0.5, 0.2, 0.3, 1, -0.4, 2}};
  const auto route_of = [&](const std::string& parameters) {
    const Problem problem = problem_of(folder, parameters);
    return route_problem(problem, poses_given(poses, pose_coordinates(problem)), from_home(), Monitor{});
  };
  const double turn = 2 * std::numbers::pi;
  const std::vector<double> nearest = {6 - turn, 0.3, 0.4, turn - 5, 0.6, 4 - turn};
  const Route turned = route_of("[j2.offset, j3.offset]");
  EXPECT_THAT(values_of(*pose_with(turned, 1)), testing::Pointwise(testing::DoubleNear(1e-12), nearest));
  EXPECT_EQ(values_of(*pose_with(turned, 2)), poses[1]);
  EXPECT_THAT(turned.notes, testing::Contains(HasSubstr("joints of pose 1 stand on another turn than in the plan")));
  const Route kept = route_of("[j2.offset, j3.offset, j1.gear]");
  EXPECT_EQ(values_of(*pose_with(kept, 1)), poses[0]) << "the gear of j1 tells turns apart";
}

TEST(Route, KeepsThePlansTurnWhereNoMotionReachesTheOneNearestToHome) {
  const TemporaryFolder folder;
  Problem problem = problem_of(folder, "[j2.offset, j3.offset]");
  const std::vector<std::vector<double>> poses = {{4.2, 0.3, 0.4, 1, 0.6, 0.2}, {1, 0.2, 0.3, 1, -0.4, 2}};
  const auto driven = [&] {
    return route_problem(problem, poses_given(poses, pose_coordinates(problem)), from_home(), Monitor{});
  };
  EXPECT_NEAR(values_of(*pose_with(driven(), 1))[0], 4.2 - 2 * std::numbers::pi, 1e-12);
  // A wall from the first axis outwards, 60 deg on the way to the nearest turn.
  const double angle = -60 * std::numbers::pi / 180;
  problem.workspace.collision->obstacles.push_back(
      {"wall", BoxShape{{3, 0.02, 2}}, {{1.59 * std::cos(angle), 1.59 * std::sin(angle), 0.6}, {0, 0, angle}}, "", 1});
  const Route route = driven();
  for (const SkippedPose& lost : route.unreachable) FAIL() << lost.pose << ": " << lost.reason;
  EXPECT_EQ(values_of(*pose_with(route, 1)), poses[0]);
  EXPECT_EQ(values_of(*pose_with(route, 2)), poses[1]);
}

TEST(Route, ReplacesLostPosesByOthersThatAddTheMostToTheRest) {
  const TemporaryFolder folder;
  Problem problem = problem_of(folder, "auto");
  const Plan plan = plan_problem(problem, {}, Monitor{});
  const PoseList all = poses_of(plan, pose_coordinates(problem));
  // Something new stands where the tip of pose 3 is.
  const Eigen::Vector3d tip = plan.poses[2].tool_pose->translation();
  problem.workspace.collision->obstacles.push_back(
      {"newcomer", SphereShape{0.1}, {tip, Eigen::Vector3d::Zero()}, "", 1});
  const Route lost = route_problem(problem, all, from_home(), Monitor{});
  ASSERT_FALSE(lost.unreachable.empty());
  EXPECT_EQ(lost.poses.size() + lost.unreachable.size(), plan.poses.size());

  const Route route = route_problem(problem, all, from_home(true), Monitor{});
  EXPECT_TRUE(route.unreachable.empty());
  EXPECT_EQ(route.poses.size(), plan.poses.size());
  ASSERT_EQ(route.replaced.size(), lost.unreachable.size());
  for (std::size_t i = 0; i < route.replaced.size(); ++i) {
    EXPECT_EQ(route.replaced[i].pose, lost.unreachable[i].pose);
    EXPECT_EQ(pose_with(route, route.replaced[i].pose), nullptr);
    EXPECT_NE(pose_with(route, route.replaced[i].by), nullptr);
    EXPECT_GT(route.replaced[i].by, int(plan.poses.size())) << "a new pose has a new id";
  }
  EXPECT_EQ(route.motions.size(), route.poses.size()) << "each has its motion";

  // Worth as `plan` and `evaluate` judge the two lists.
  PoseList driven;
  for (const PlannedPose& pose : route.poses) driven.configurations.push_back(values_of(pose));
  const Plan judged = evaluate_problem(problem, driven, {}, Monitor{}).plan;
  const double interest = double(std::count_if(judged.parameters.begin(), judged.parameters.end(), [](const auto& p) {
    return p.label.role == Role::interest && p.dropped_because.empty();
  }));
  ASSERT_TRUE(route.worth.has_value());
  EXPECT_NEAR(route.worth->efficiency, std::exp((judged.log_det - plan.log_det) / interest), 1e-9);
  EXPECT_GT(route.worth->efficiency, lost.worth->efficiency);
  EXPECT_THAT(route_summary(route), testing::StartsWith(fmt::format("{} of 8 poses", route.replaced.size())));
  EXPECT_THAT(route_json(route), HasSubstr(fmt::format("\"by\": {}", route.replaced.front().by)));

  // The page of the plan with this route has the new poses in the place of those that are replaced.
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  brief.route = folder.write("route.json", route_json(route));
  const Report report = report_problem(problem, folder.write("plan.json", plan_json(plan)), brief, Monitor{});
  const PoseList shown = read_poses_text(report.plan_json, "shown", pose_coordinates(problem));
  ASSERT_EQ(shown.ids.size(), plan.poses.size());
  for (std::size_t i = 0; i < shown.ids.size(); ++i) {
    const PlannedPose* stop = pose_with(route, shown.ids[i]);
    ASSERT_NE(stop, nullptr) << shown.ids[i];
    const bool is_new = shown.ids[i] > int(plan.poses.size());
    if (is_new) EXPECT_EQ(shown.configurations[i], values_of(*stop));
    else EXPECT_EQ(shown.ids[i], plan.poses[i].id);
  }
  EXPECT_THAT(report.notes,
              testing::Contains(HasSubstr(fmt::format("Pose {} is replaced by pose {} of the route",
                                                      route.replaced.front().pose, route.replaced.front().by))));
}

TEST(Route, StatesItsTimeAtTheSpeedOfProgramsToo) {
  const TemporaryFolder folder;
  const Problem problem = problem_of(folder, "[j2.offset, j3.offset]");
  Route route = route_problem(
      problem, poses_given({{0.5, 0.2, 0.3, 1, -0.4, 2}, {-1, 0, 0.3, 0.2, 1, 1}}, pose_coordinates(problem)),
      from_home(), Monitor{});
  const double seconds = route.travel_seconds();
  ASSERT_LT(10 * seconds, 120);
  EXPECT_THAT(route_summary(route), HasSubstr(fmt::format("2 poses in {:.1f} s of motion", seconds)));
  EXPECT_THAT(route_summary(route), HasSubstr(fmt::format("10 % of exported programs about {:.1f} s", 10 * seconds)));
  // The planned order's time is a lower bound: where it is less, nothing is known to be saved.
  route.planned_seconds = 0.9 * route.travel_seconds();
  EXPECT_THAT(route_summary(route), testing::Not(HasSubstr("saved")));
  route.planned_seconds = 2 * (route.travel_seconds() + route.change_seconds());
  EXPECT_THAT(route_summary(route), HasSubstr(" or more: 50 % saved"));
}

}  // namespace
}  // namespace posewright
