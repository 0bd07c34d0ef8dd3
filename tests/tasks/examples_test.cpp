// Every example file is read, observed and planned.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>

#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/recompute.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

class Examples : public testing::TestWithParam<std::string> {};

/// One of every kind of robot and instrument has its poses moved between the candidates too; that takes the most time.
bool is_moved(const std::string& file) {
  for (const char* name : {"telescope", "delta", "five_bar", "elastostatic", "camera", "rosi"})
    if (file.find(name) != std::string::npos) return true;
  return false;
}

TEST_P(Examples, ArePlannedAndTheStatedLogDetIsThatOfTheWrittenPoses) {
  const Problem problem = example(GetParam());
  DesignEdits options = DesignEdits().edit("candidates", 100);
  if (problem.workspace.motion.reachable) options.edit("candidates", 40);  // a way to every one of them is sought
  options.edit("restarts", 1);
  if (!is_moved(GetParam())) options.edit("method", "exchange");
  const Plan plan = planned(problem, options);
  EXPECT_EQ(int(plan.poses.size()), problem.design.poses->value);
  EXPECT_LE(plan.certificate.efficiency, 1.0);
  // The bounds of other criteria are on their own scale, and with hardly more poses than needed they are far off.
  if (plan.criterion == "o1") {
    EXPECT_LE(plan.log_det, plan.certificate.bound);
    EXPECT_GT(plan.certificate.efficiency, 0.8);
  }
  for (const PlannedParameter& p : plan.parameters) {
    if (p.sigma) {
      EXPECT_GT(*p.sigma, 0) << p.label.name;
    }
  }
  // Automatic subsets are chosen by the program, so only explicit variants are recomputed by the other road.
  if (find_variant(problem, "").automatic) return;
  EXPECT_NEAR(recomputed_log_det(problem, plan.variant, configurations_of(problem, plan)), plan.log_det,
              1e-8 * std::abs(plan.log_det));
}

TEST_P(Examples, AreObserved) {
  const Problem problem = example(GetParam());
  ObserveOptions options;
  options.candidates = 300;
  for (const Observation& o : observe_problem(problem, options, Monitor{})) {
    EXPECT_GT(o.identifiability.rank, 0) << o.variant;
    EXPECT_TRUE(o.smallest_poses.has_value()) << o.variant;
    ASSERT_TRUE(o.practical.has_value()) << o.variant;
    EXPECT_TRUE(o.practical->sigma.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(All, Examples, testing::ValuesIn(example_files()),
                         [](const auto& row) { return test_name(row.param); });

Observation observed(const std::string& file, const std::string& variant) {
  ObserveOptions options;
  options.variant = variant;
  options.candidates = 1000;
  return observe_problem(read_problem(fs::path(POSEWRIGHT_SOURCE_DIR) / "examples" / file), options, Monitor{}).front();
}

double sigma_of(const Observation& o, const std::string& name) {
  for (std::size_t j = 0; j < o.kept.size(); ++j)
    if (o.kept[j].name == name) return o.practical->sigma[Eigen::Index(j)];
  return NAN;
}

TEST(Telescope, KappaAndUxHideBehindEachOther) {
  const Observation together = observed("telescope/problem.yaml", "kappa_and_ux"),
                    alone = observed("telescope/problem.yaml", "linear_common");
  EXPECT_GT(sigma_of(together, "kappa"), 5 * sigma_of(alone, "kappa"));
  bool named = false;
  for (const Dependency& d : together.practical->near) {
    if (together.kept[std::size_t(d.dropped)].name != "kappa") continue;
    for (const Dependency::Term& t : d.terms)
      named = named || together.kept[std::size_t(t.parameter)].name.ends_with(".ux");
  }
  EXPECT_TRUE(named) << "the near dependence of kappa names ux";
  // The recommendation keeps kappa and fixes every ux, as the published study does.
  for (std::size_t j = 0; j < together.kept.size(); ++j) {
    const auto& kept = together.practical->recommended;
    const bool recommended = std::find(kept.begin(), kept.end(), int(j)) != kept.end();
    const std::string& name = together.kept[j].name;
    if (name == "kappa" || name.ends_with(".ux")) {
      EXPECT_EQ(recommended, name == "kappa") << name;
    }
  }
}

TEST(Telescope, TheOtherSurrogateHasTheWholeWorkspaceWithinTheStrokeAndThePublishedAccuracy) {
  const auto model =
      make_model(read_problem(fs::path(POSEWRIGHT_SOURCE_DIR) / "examples/telescope/within_stroke.yaml"));
  const std::array<double, 6> half = {2e-3, 2e-3, 0.2e-3, M_PI / 180, M_PI / 180, M_PI / 180};
  double worst = 0, stroke = 0;
  for (int corner = 0; corner < 64; ++corner) {
    std::vector<double> q(6), rho(6);
    for (std::size_t k = 0; k < 6; ++k) q[k] = (corner >> k & 1) != 0 ? half[k] : -half[k];
    ASSERT_TRUE(model->actuator_values(q, rho));
    for (const double r : rho) stroke = std::max(stroke, std::abs(r));
    // ∂ρ/∂(position, rotation) by differences; its inverse times every combination of ±1 µm.
    Eigen::Matrix<double, 6, 6> J;
    for (std::size_t k = 0; k < 6; ++k) {
      std::vector<double> ahead = q, behind = q, a(6), b(6);
      ahead[k] += 1e-6, behind[k] -= 1e-6;
      ASSERT_TRUE(model->actuator_values(ahead, a) && model->actuator_values(behind, b));
      for (std::size_t i = 0; i < 6; ++i) J(Eigen::Index(i), Eigen::Index(k)) = (a[i] - b[i]) / 2e-6;
    }
    const Eigen::Matrix<double, 6, 6> inverse = J.inverse();
    for (int signs = 0; signs < 64; ++signs) {
      Eigen::Matrix<double, 6, 1> error;
      for (int i = 0; i < 6; ++i) error[i] = (signs >> i & 1) != 0 ? 1e-6 : -1e-6;
      worst = std::max(worst, (inverse * error).head<3>().norm());
    }
  }
  EXPECT_LT(stroke, 1.3e-3);
  EXPECT_NEAR(worst, 6e-6, 0.1e-6);
}

TEST(Telescope, AFreeRowOfKCannotBeToldFromItsOwnLeg) {
  const Observation o = observed("telescope/problem.yaml", "row_of_K");
  EXPECT_EQ(o.exact_rank, 36);
  EXPECT_EQ(o.identifiability.rank, 34);
  for (const Dependency& d : o.identifiability.dependencies) {
    const std::string equation = describe(d, o.parameters);
    EXPECT_THAT(equation, testing::StartsWith("leg_1."));
    EXPECT_THAT(equation, testing::HasSubstr("K_1"));
  }
}

TEST(Telescope, SevenParametersALegNeedSevenPoses) {
  EXPECT_EQ(observed("telescope/problem.yaml", "rigid").smallest_poses, 7);
  EXPECT_EQ(observed("telescope/problem.yaml", "rigid_6").smallest_poses, 6);
}

/// What plan_problem() says of a changed example.
std::string refusal(const std::string& file, const std::function<void(Problem&)>& change) {
  Problem problem = read_problem(fs::path(POSEWRIGHT_SOURCE_DIR) / "examples" / file);
  change(problem);
  DesignEdits options = DesignEdits().edit("candidates", 100);
  return message_of<std::runtime_error>([&] { planned(problem, options); }, "accepted");
}

TEST(Refusals, EachSaysWhatDoesNotFit) {
  EXPECT_THAT(
      refusal("instruments/camera_on_hand.yaml",
              [](Problem& p) { std::get<CameraMeasurement>(p.measurement.instrument).board.position.x() = -2.6; }),
      testing::HasSubstr("'no joint angles for a view of the targets' rejects 100 %"));
  EXPECT_THAT(refusal("instruments/cables.yaml",
                      [](Problem& p) {
                        auto& distance = std::get<DistanceMeasurement>(p.measurement.instrument);
                        distance.range_lower = 50, distance.range_upper = 60;
                      }),
              testing::HasSubstr("'distance out of range' rejects 100 %"));
  EXPECT_THAT(refusal("telescope/problem.yaml",
                      [](Problem& p) {
                        p.measurement.instrument = JointsMeasurement{{}, 1e-3, Quantity::number};
                      }),
              testing::HasSubstr("this robot has no redundant joint sensors"));
  EXPECT_THAT(refusal("five_bar/problem.yaml",
                      [](Problem& p) {
                        std::get<JointsMeasurement>(p.measurement.instrument).sensors = {{"leg_3.elbow", 17}};
                      }),
              testing::HasSubstr("problem.yaml:17: 'leg_3.elbow' is not a redundant sensor of this robot; sensors: "
                                 "leg_1.elbow, leg_2.elbow"));
  EXPECT_THAT(refusal("telescope/problem.yaml",
                      [](Problem& p) {
                        p.variants.front().convention = VariantSpec::Convention::dh;
                        p.variants.front().automatic = true;
                      }),
              testing::HasSubstr("parameters dh and mdh are those of a serial arm"));
  EXPECT_THAT(refusal("kr270/elastostatic.yaml",
                      [](Problem& p) { p.variants.front().convention = VariantSpec::Convention::mdh; }),
              testing::HasSubstr("parameters dh and mdh are geometric"));
  EXPECT_THAT(refusal("kr270/problem.yaml", [](Problem& p) { p.measurement.loaded_minus_unloaded = true; }),
              testing::HasSubstr("needs robot: elastostatic with at least two load cases"));
  EXPECT_THAT(refusal("kr270/elastostatic.yaml",
                      [](Problem& p) {
                        std::get<SerialArmSpec>(p.robot).elastostatic->listed->joint = {"joint_9", 16};
                      }),
              testing::HasSubstr(":16: 'joint_9' is not a joint of this arm"));
}

TEST(ListedPositions, OnePoseForEachSuffices) {
  // Five positions of one joint, nine parameters, nine rows: one pose at each position determines everything.
  EXPECT_EQ(observed("kr270/elastostatic.yaml", "compliances").smallest_poses, 5);
  DesignEdits options = DesignEdits().edit("candidates", 1000).edit("poses", 5);
  const Plan plan = planned(example("kr270/elastostatic.yaml"), options);
  std::vector<double> second;
  for (const PlannedPose& pose : plan.poses) second.push_back(pose.configuration[1].value);
  std::sort(second.begin(), second.end());
  EXPECT_EQ(std::unique(second.begin(), second.end()) - second.begin(), 5);
}

TEST(Refusals, UnitsOfTheWrongKindAreNotTakenAsSI) {
  EXPECT_THAT(
      refusal("kr270/elastostatic.yaml",
              [](Problem& p) { std::get<SerialArmSpec>(p.robot).elastostatic->listed->quantity = Quantity::length; }),
      testing::HasSubstr("the listed positions of 'joint_a2' have the wrong unit; allowed: rad, mrad, urad, deg"));
  EXPECT_THAT(
      refusal("five_bar/problem.yaml",
              [](Problem& p) { std::get<JointsMeasurement>(p.measurement.instrument).quantity = Quantity::length; }),
      testing::HasSubstr("the noise of the joint sensors has the wrong unit"));
}

TEST(Refusals, TestPosesThatDoNotFitTheRobotAreNamed) {
  const auto with = [](std::vector<std::vector<Measured>> at) {
    return [at](Problem& p) {
      p.design.test_poses = TestPosesSpec{};
      p.design.test_poses->at = at;
      p.design.test_poses->line = 33;
    };
  };
  EXPECT_THAT(refusal("delta/problem.yaml", with({{{0.1}, {0.1}}})),
              testing::HasSubstr("problem.yaml:33: a test pose has 2 values"));
  EXPECT_THAT(refusal("delta/problem.yaml", with({{{0.1}, {0.1, Quantity::angle}, {0.1}}})),
              testing::HasSubstr("a test pose has the wrong unit for 'y'; allowed: m, mm, um, nm"));
  EXPECT_THAT(refusal("delta/problem.yaml", with({{{5}, {0.1}, {0.1}}})),
              testing::HasSubstr("test pose 1 is not feasible: limits"));
  EXPECT_THAT(refusal("delta/problem.yaml", [](Problem& p) { p.design.criterion.value = "test_pose"; }),
              testing::HasSubstr("set design: test_poses"));
}

TEST(Refusals, TestPosesUnderALoadThatIsNotThereOrDoesNothingAreNamed) {
  const auto under = [](const std::string& load) {
    return [load](Problem& p) {
      TestPosesSpec& tests = p.design.test_poses.emplace();
      tests.random = 3;
      tests.load_case = Located<std::string>{load, 33};
      p.design.criterion.value = "test_pose";
      p.design.poses = Located<int>{12, 34};
    };
  };
  EXPECT_THAT(refusal("delta/problem.yaml", under("tool")),
              testing::HasSubstr("problem.yaml:33: design.test_poses.load_case: there is no choice of load cases"));
  EXPECT_THAT(refusal("kr270/elastostatic.yaml", under("tool")),
              testing::HasSubstr("'tool' is not a load case; allowed: unloaded, at_the_flange, beside_it"));
  EXPECT_THAT(refusal("kr270/elastostatic.yaml", under("unloaded")),
              testing::HasSubstr("no parameter that is identified moves the robot at the test poses"));
}

TEST(Refusals, AnAutomaticVariantWithNothingLeftSaysWhy) {
  EXPECT_THAT(refusal("kr270/problem.yaml",
                      [](Problem& p) {
                        VariantSpec& v = p.variants.front();
                        v.automatic = true;
                        v.parameters.clear();
                        v.fixed = {{"joint_a?.*", 1}};
                        v.nuisance = {{"base.*", 1}, {"target.*", 1}};
                        p.robot = std::get<SerialArmSpec>(p.robot);
                      }),
              testing::AnyOf(
                  testing::HasSubstr("leaves no parameter of interest free"),
                  testing::HasSubstr("no parameter of interest can be identified separately from the nuisance ones")));
}

TEST(BallBar, BothEndsCarryTheSameLoad) {
  Problem problem = example("instruments/ball_bar.yaml");
  ElastostaticSpec springs;
  LoadCaseSpec light, heavy;
  light.name = "light", heavy.name = "heavy", heavy.mass = 100;
  springs.loads = {light, heavy};
  std::get<SerialArmSpec>(problem.robot).elastostatic = springs;
  DesignEdits options = DesignEdits().edit("method", "exchange").edit("candidates", 150).edit("restarts", 1);
  const Plan plan = planned(problem, options);
  for (const PlannedPose& pose : plan.poses) {
    EXPECT_EQ(pose.configuration.size(), 12U);
    const std::string load = label_of(pose.choices, "load_case");
    EXPECT_TRUE(load == "light" || load == "heavy");
  }
}

TEST(FiveBarSelfCalibration, AnglesAloneTellNeitherPlaceNorSize) {
  const Observation o = observed("five_bar/problem.yaml", "everything");
  EXPECT_EQ(o.identifiability.rank, 8) << "of twelve: two for place, one for direction, one for size are lost";
}

}  // namespace
}  // namespace posewright
