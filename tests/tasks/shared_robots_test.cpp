// Every real URDF of the shared robots: a plan with parameters `auto` and full pose measurement.

#include <gtest/gtest.h>

#include <filesystem>

#include "posewright/problem/read_problem.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

struct Robot {
  const char* name;
  const char* urdf;
  const char* tip;
  int revolute;
};

void PrintTo(const Robot& robot, std::ostream* out) { *out << robot.name; }

class SharedRobots : public testing::TestWithParam<Robot> {};

TEST_P(SharedRobots, AutomaticSubsetHas4RPlus6ParametersAndAPlanIsFound) {
  const std::filesystem::path robots = std::filesystem::path(POSEWRIGHT_SHARED_DIR) / "robots";
  if (!std::filesystem::exists(robots)) GTEST_SKIP() << "the folder of shared robots is absent";
  const TemporaryFolder folder;
  const Robot& robot = GetParam();
  const Problem problem = read_problem(folder.write(
      "p.yaml",
      "posewright: 1\nrobot: {urdf: \"" + (robots / robot.name / robot.urdf).string() + "\", tip: " + robot.tip +
          "}\n" +
          "measurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}\n"
          "variants: {all: {parameters: auto}}\n"
          "design: {criterion: o1, poses: 20, candidates: 500, restarts: 1, method: exchange}\n"));
  ObserveOptions options;
  options.candidates = 500;
  const Observation o = observe_problem(problem, options, Monitor{}).front();
  std::string equations;
  for (const Dependency& d : o.identifiability.dependencies) equations += "  " + describe(d, o.parameters) + "\n";
  EXPECT_EQ(o.identifiability.rank, 4 * robot.revolute + 6) << equations;
  const Plan plan = plan_problem(problem, {}, Monitor{});
  EXPECT_EQ(plan.poses.size(), 20U);
  EXPECT_GT(plan.certificate.efficiency, 0.8);
  EXPECT_LE(plan.log_det, plan.certificate.bound);
  for (const PlannedParameter& p : plan.parameters) EXPECT_EQ(p.sigma.has_value(), p.dropped_because.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, SharedRobots,
    testing::Values(Robot{"kuka_kr300_r2700_2", "kuka_quantec_support/urdf/kr300_r2700_2.urdf", "tool0", 6},
                    Robot{"abb_irb120_3_58", "abb_irb120_support/urdf/irb120_3_58.urdf", "tool0", 6},
                    Robot{"fanuc_m10ia", "moveit_resources_fanuc_description/urdf/fanuc.urdf", "tool0", 6},
                    Robot{"franka_panda", "moveit_resources_panda_description/urdf/panda.urdf", "panda_link8", 7},
                    Robot{"ur10", "example-robot-data/robots/ur_description/urdf/ur10_robot.urdf", "tool0", 6},
                    Robot{"staubli_tx2_90", "staubli_tx2_90_support/urdf/tx2_90.urdf", "tool0", 6}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace posewright
