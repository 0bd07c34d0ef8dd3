// Every real robot of the shared folder: `init` finds its chain, and what it writes plans.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

struct Robot {
  const char *name, *urdf, *chain;
};

void PrintTo(const Robot& robot, std::ostream* out) { *out << robot.name; }

class InitOfSharedRobots : public testing::TestWithParam<Robot> {};

TEST_P(InitOfSharedRobots, FindsTheChainAndPlansForTrackerAndCamera) {
  const std::filesystem::path robots = std::filesystem::path(POSEWRIGHT_SHARED_DIR) / "robots";
  if (!std::filesystem::exists(robots)) GTEST_SKIP() << "the folder of shared robots is absent";
  const std::string urdf = (robots / GetParam().name / GetParam().urdf).string();
  const TemporaryFolder folder;
  for (const std::vector<std::string>& instrument :
       {std::vector<std::string>{"--tracker"}, {"--camera", "realsense-d435"}}) {
    std::vector<std::string> words = {"init", urdf, "--yes", "--force"};
    words.insert(words.end(), instrument.begin(), instrument.end());
    const ProgramRun made = run_program(folder.path(), words);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, HasSubstr(GetParam().chain));
    EXPECT_EQ(made.err, "") << "the meshes are there";
    // Fewer candidates and no proof: the test asks whether it plans, not how well.
    const ProgramRun plan = run_program(folder.path(), {"plan", "problem.yaml", "--candidates", "60", "--restarts", "1",
                                                        "--proof-time", "0", "--force"});
    EXPECT_EQ(plan.exit_code, 0) << plan.err;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, InitOfSharedRobots,
    testing::Values(
        Robot{"kuka_kr300_r2700_2", "kuka_quantec_support/urdf/kr300_r2700_2.urdf", "6 joints from base_link to tool0"},
        Robot{"abb_irb120_3_58", "abb_irb120_support/urdf/irb120_3_58.urdf", "6 joints from base_link to tool0"},
        Robot{"fanuc_m10ia", "moveit_resources_fanuc_description/urdf/fanuc.urdf", "6 joints from base_link to tool0"},
        Robot{"franka_panda", "moveit_resources_panda_description/urdf/panda.urdf",
              "7 joints from panda_link0 to panda_hand"},
        Robot{"ur10", "example-robot-data/robots/ur_description/urdf/ur10_robot.urdf",
              "6 joints from base_link to tool0"},
        Robot{"staubli_tx2_90", "staubli_tx2_90_support/urdf/tx2_90.urdf", "6 joints from base_link to tool0"}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace posewright
