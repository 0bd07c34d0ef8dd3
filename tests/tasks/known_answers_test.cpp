// Analytic optima and published facts, through the whole way from problem text to plan.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/recompute.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr const char* planar_2r = R"(<robot name="planar">
  <link name="base"/><link name="upper"/><link name="lower"/><link name="tip"/>
  <joint name="q1" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
  <joint name="q2" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="1.5 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="end" type="fixed"><parent link="lower"/><child link="tip"/><origin xyz="0.8 0 0"/></joint>
</robot>)";

constexpr const char* planar_arm_problem = R"(posewright: 1
robot: {urdf: planar.urdf}
measurement:
  type: position
  target: [0, 0, 0]
  components: [x, y]
  device: {type: isotropic, noise: 1}
variants:
  lengths_and_offsets:
    parameters: [q2.x, target.target.x, q1.offset, q2.offset]
design: {criterion: o1, poses: 6, candidates: 6000}
)";

TEST(KnownAnswers, Planar2RReachesTheAnalyticOptimumAndTheCertificateSaysSo) {
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_2r);
  const Problem problem = read_problem(folder.write("p.yaml", planar_arm_problem));
  const Plan plan = plan_problem(problem, {}, Monitor{});
  // 2n ln N + 2 Σ ln l_i with n = 2, N = 6, unit noise.
  const double optimum = 4 * std::log(6.0) + 2 * (std::log(1.5) + std::log(0.8));
  EXPECT_NEAR(plan.log_det, optimum, 1e-6 * optimum);
  EXPECT_LE(plan.log_det, optimum + 1e-9);
  EXPECT_GE(plan.certificate.efficiency, 0.999);
  double cosine = 0, sine = 0;
  for (const PlannedPose& pose : plan.poses) {
    cosine += std::cos(pose.configuration[1].value) / 6;
    sine += std::sin(pose.configuration[1].value) / 6;
  }
  EXPECT_NEAR(cosine, 0, 2e-3);
  EXPECT_NEAR(sine, 0, 2e-3);
}

TEST(KnownAnswers, Planar2RDeterminantFollowsTheFormulaForAnyPoses) {
  // det M = (N² − |z|²)² (l1 l2)², z = Σ exp(i q2).
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_2r);
  const Problem problem = read_problem(folder.write("p.yaml", planar_arm_problem));
  Random random(1, 0);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::vector<double>> poses;
    double re = 0, im = 0;
    for (int i = 0; i < 5; ++i) {
      poses.push_back({random.uniform(-3, 3), random.uniform(-3, 3)});
      re += std::cos(poses.back()[1]);
      im += std::sin(poses.back()[1]);
    }
    const double expected = 2 * std::log(25 - re * re - im * im) + 2 * std::log(1.5 * 0.8);
    EXPECT_NEAR(recomputed_log_det(problem, "lengths_and_offsets", poses), expected, 1e-9);
  }
}

TEST(KnownAnswers, Planar2RTestPoseErrorFollowsTheFormula) {
  // ρ0² = 4σ² (N − Re(z e^{−i q2⁰})) / (N² − |z|²), z = Σ e^{i q2}, whatever the links' lengths.
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_2r);
  std::string text = planar_arm_problem;
  text.replace(
      text.find("design: {criterion: o1, poses: 6, candidates: 6000}"), 51,
      "design: {poses: 5, candidates: 300, restarts: 2, criterion: test_pose, test_poses: {at: [[0.3, 0.7]], point: "
      "[0, 0, 0]}}");
  // Measured as a position of the tip, so that the second link's length is the tool's.
  text.replace(text.find("type: position\n  target: [0, 0, 0]"), 34, "type: pose");
  text.replace(text.find("noise: 1}"), 9, "noise: {position: 1, rotation: 1}}");
  text.replace(text.find("target.target.x"), 15, "tool.x");
  const Problem problem = read_problem(folder.write("p.yaml", text));
  const Plan plan = plan_problem(problem, {}, Monitor{});
  double re = 0, im = 0;
  for (const PlannedPose& pose : plan.poses) {
    re += std::cos(pose.configuration[1].value);
    im += std::sin(pose.configuration[1].value);
  }
  const double towards = re * std::cos(0.7) + im * std::sin(0.7);
  ASSERT_TRUE(plan.rho0.has_value());
  EXPECT_NEAR(*plan.rho0 * *plan.rho0, 4 * (5 - towards) / (25 - re * re - im * im), 1e-9);
  EXPECT_NEAR(plan.criterion_value, -*plan.rho0 * *plan.rho0, 1e-11);
  EXPECT_TRUE(plan.certificate.proved);
  EXPECT_GT(plan.certificate.efficiency, 0.9);
  // Measuring near the test pose only helps it: better than the D-optimal plan, for which z = 0.
  EXPECT_LT(*plan.rho0 * *plan.rho0, 4.0 / 5);
}

TEST(KnownAnswers, EveryCriterionIsBestUnderItsOwnPlan) {
  Problem problem = example("delta/problem.yaml");
  problem.design.test_poses = TestPosesSpec{};
  problem.design.test_poses->random = 20;
  DesignEdits options = DesignEdits().edit("candidates", 60).edit("restarts", 4);
  // Compared over the same candidates: poses between them would be local optima of their own.
  options.edit("method", "exchange");
  options.edit("poses", 14);
  std::map<std::string, Plan> plans;
  for (const char* criterion : {"o1", "a", "o2", "o3", "o5", "test_pose", "test_pose_max"}) {
    options.edit("criterion", criterion);
    plans[criterion] = planned(problem, options);
  }
  const auto worst = [](const Plan& p) { return *std::max_element(p.test_errors.begin(), p.test_errors.end()); };
  for (const auto& [name, other] : plans) {
    EXPECT_GE(plans["o1"].log_det, other.log_det - 1e-9) << name;
    EXPECT_GE(plans["o2"].indices.o2, other.indices.o2 * (1 - 1e-9)) << name;
    EXPECT_GE(plans["o3"].indices.o3, other.indices.o3 * (1 - 1e-9)) << name;
    EXPECT_GE(plans["o5"].indices.o5, other.indices.o5 * (1 - 1e-9)) << name;
    EXPECT_LE(*plans["test_pose"].rho0, *other.rho0 * (1 + 1e-9)) << name;
    EXPECT_LE(worst(plans["test_pose_max"]), worst(other) * (1 + 1e-9)) << name;
  }
}

TEST(KnownAnswers, Kr270HasRank33AndAPlanOf18ReachesTheKnownEfficiency) {
  const Problem problem = example("kr270/problem.yaml");
  ObserveOptions observe;
  observe.variant = "geometric";
  const Observation observation = observe_problem(problem, observe, Monitor{}).front();
  EXPECT_EQ(observation.parameters.size(), 33U);
  EXPECT_EQ(observation.identifiability.rank, 33);
}

TEST(KnownAnswers, Kr270PlanOf18Among1500ReachesTheKnownEfficiency) {
  // The known figure counts all 33 parameters alike, so none is nuisance here.
  Problem problem = example("kr270/problem.yaml");
  VariantSpec& variant = problem.variants.front();
  variant.parameters.insert(variant.parameters.end(), variant.nuisance.begin(), variant.nuisance.end());
  variant.nuisance.clear();
  DesignEdits options = DesignEdits().edit("candidates", 1500).edit("restarts", 1).edit("method", "exchange");
  const Plan plan = planned(problem, options);
  EXPECT_EQ(plan.poses.size(), 18U);
  EXPECT_GE(plan.certificate.efficiency, 0.95);
}

TEST(KnownAnswers, Kr270AutomaticSubsetHasTheSameNumber) {
  const Problem problem = example("kr270/problem.yaml");
  ObserveOptions observe;
  observe.variant = "automatic";
  const Observation observation = observe_problem(problem, observe, Monitor{}).front();
  EXPECT_EQ(observation.identifiability.rank, 33);
}

TEST(KnownAnswers, TelescopeReportsHeightsAndLengthAsDependent) {
  const Problem problem = example("telescope/problem.yaml");
  ObserveOptions observe;
  observe.variant = "all_free";
  const Observation o = observe_problem(problem, observe, Monitor{}).front();
  std::vector<std::string> equations;
  for (const Dependency& d : o.identifiability.dependencies) equations.push_back(describe(d, o.parameters));
  for (int leg = 1; leg <= 6; ++leg) {
    const std::string name = "leg_" + std::to_string(leg);
    EXPECT_THAT(equations, Contains(testing::StartsWith(name + ".az = ")));
    EXPECT_THAT(equations, Contains(testing::StartsWith(name + ".bz = ")));
  }
}

TEST(KnownAnswers, StatedLogDetIsRecomputedFromTheWrittenPosesAlone) {
  for (const std::string name : {"telescope", "kr270"}) {
    const Problem problem = example(name + "/problem.yaml");
    DesignEdits options = DesignEdits().edit("candidates", 200).edit("restarts", 1).edit("method", "exchange");
    const Plan plan = planned(problem, options);
    const PlanFile written = read_back(plan_json(plan));
    EXPECT_NEAR(recomputed_log_det(problem, written.variant, written.poses), written.log_det, 1e-9) << name;
    EXPECT_LE(written.log_det, written.log_det_bound) << name;
    EXPECT_EQ(read_back_csv(poses_csv(plan), written.poses.front().size()), written.poses) << name;
  }
}

TEST(KnownAnswers, SameProblemAndSeedGiveTheSamePlanOnAnyNumberOfThreads) {
  const Problem problem = example("delta/problem.yaml");
  DesignEdits options = DesignEdits().edit("candidates", 100).edit("restarts", 3);
  options.threads = 1;
  const std::string one = poses_csv(planned(problem, options));
  options.threads = 3;
  EXPECT_EQ(poses_csv(planned(problem, options)), one);
  options.seed = 1;
  EXPECT_NE(poses_csv(planned(problem, options)), one);
}

TEST(KnownAnswers, TooFewPosesNameTheShortfallAndTheParameters) {
  const Problem problem = example("kr270/problem.yaml");
  DesignEdits options = DesignEdits().edit("candidates", 500).edit("poses", 4);
  try {
    planned(problem, options);
    FAIL() << "accepted";
  } catch (const CannotDo& error) {
    // Six equations a pose and three more once: 27 of 33 with four poses, five poses needed.
    EXPECT_THAT(error.what(), HasSubstr("4 poses determine 27 of 33 parameters"));
    EXPECT_THAT(error.what(), HasSubstr("at least 5 poses are needed"));
  }
}

TEST(KnownAnswers, DependentExplicitVariantIsRefusedWithItsEquation) {
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_2r);
  std::string text = planar_arm_problem;
  text.replace(text.find("q1.offset"), 9, "base.rz, q1.offset");
  const Problem problem = read_problem(folder.write("p.yaml", text));
  EXPECT_THAT(message_of<CannotDo>([&] { plan_problem(problem, {}, Monitor{}); }),
              testing::AnyOf(HasSubstr("q1.offset = base.rz"), HasSubstr("base.rz = q1.offset")));
}

}  // namespace
}  // namespace posewright
