// Plans for robots drawn from the tolerances: the search against all plans that there are, figures against the
// definition, drawn robots against models that were built with other nominal values.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "posewright/model/whitening.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/search/robust_search.hpp"
#include "posewright/study/drawn_robots.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/planar_arm.hpp"
#include "tests/kit/random_blocks.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

constexpr int scenarios = 6, candidates = 9, columns = 5, rows = 2, poses = 4, nuisance = 1;

/// Candidates as several scenarios see them, each far from the others; one cannot be measured in the last.
std::vector<BlockArray> several_blocks() {
  std::vector<BlockArray> all;
  const BlockArray common = random_blocks(candidates, rows, columns, 5);
  for (int k = 0; k < scenarios; ++k) {
    all.push_back(random_blocks(candidates, rows, columns, 100 + std::uint64_t(k)));
    all.back().all() = common.all() + 0.8 * all.back().all();
  }
  all.back().block(2).setZero();
  return all;
}

double log_det_of_interest(const BlockArray& blocks, const std::vector<int>& plan) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(columns, columns);
  for (const int i : plan) M += blocks.block(std::size_t(i)).transpose() * blocks.block(std::size_t(i));
  return std::log(M.determinant()) - std::log(M.topLeftCorner(nuisance, nuisance).determinant());
}

/// The aim's number from its definition in words.
double by_words(const RobustAim& aim, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  if (aim.measure == RobustAim::Measure::worst) return values.front();
  if (aim.measure == RobustAim::Measure::mean) return std::accumulate(values.begin(), values.end(), 0.0) / scenarios;
  const double wanted = aim.share * scenarios;
  double sum = 0;
  for (int k = 0; k < scenarios; ++k) sum += std::clamp(wanted - k, 0.0, 1.0) * values[std::size_t(k)];
  return sum / wanted;
}

std::vector<std::vector<int>> all_plans() {
  std::vector<std::vector<int>> plans;
  std::vector<char> chosen(candidates, 0);
  std::fill_n(chosen.begin(), poses, char(1));
  do {
    plans.emplace_back();
    for (int i = 0; i < candidates; ++i)
      if (chosen[std::size_t(i)] != 0) plans.back().push_back(i);
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return plans;
}

RobustRequest request_of(const std::vector<BlockArray>& blocks, const RobustAim& aim, int threads) {
  RobustRequest request;
  request.aim = aim;
  request.scenarios = scenarios;
  request.poses = poses;
  request.nuisance = nuisance;
  request.plan = {0, 1, 2, 3};
  request.nominal = random_blocks(candidates, rows, columns, 5);
  request.planner.threads = threads;
  request.blocks = [&blocks](int k, const std::vector<int>& which) {
    std::vector<int> all(candidates);
    std::iota(all.begin(), all.end(), 0);
    return blocks[std::size_t(k)].subset(which.empty() ? all : which);
  };
  return request;
}

class Robust : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Aims, Robust, testing::Values("mean", "worst", "tail 0.4"));

TEST_P(Robust, TheBestOfAllPlansIsFoundAndItsFiguresAreThoseOfTheDefinition) {
  const RobustAim aim = *robust_aim_of(GetParam());
  const std::vector<BlockArray> blocks = several_blocks();
  const RobustResult found = search_robust(request_of(blocks, aim, 1), Monitor());
  ASSERT_FALSE(found.stopped);
  EXPECT_EQ(found.unreached, 1);
  const auto efficiencies = [&](const std::vector<int>& plan) {
    std::vector<double> values;
    for (int k = 0; k < scenarios; ++k)
      values.push_back((log_det_of_interest(blocks[std::size_t(k)], plan) - found.references[std::size_t(k)]) /
                       (columns - nuisance));
    return values;
  };
  double best = -1e300;
  for (const std::vector<int>& plan : all_plans()) {
    const std::vector<double> values = efficiencies(plan);
    for (const double value : values) EXPECT_LE(value, 1e-9) << "a reference is exceeded";
    best = std::max(best, by_words(aim, values));
  }
  EXPECT_NEAR(std::log(found.robust.combined), best, 1e-9);
  EXPECT_NEAR(by_words(aim, efficiencies(found.plan)), best, 1e-9);
  EXPECT_NEAR(std::log(found.nominal.combined), by_words(aim, efficiencies({0, 1, 2, 3})), 1e-9);
  EXPECT_LE(best, std::log(found.bound) + 1e-9) << "the bound is exceeded";
  EXPECT_LT(found.bound, 1.0);
  const std::vector<double> each = efficiencies(found.plan);
  for (int k = 0; k < scenarios; ++k)
    EXPECT_NEAR(std::log(found.robust.efficiency[std::size_t(k)]), each[std::size_t(k)], 1e-9);
}

TEST_P(Robust, ResultIsTheSameOnAnyNumberOfThreads) {
  const RobustAim aim = *robust_aim_of(GetParam());
  const std::vector<BlockArray> blocks = several_blocks();
  const RobustResult one = search_robust(request_of(blocks, aim, 1), Monitor());
  const RobustResult three = search_robust(request_of(blocks, aim, 3), Monitor());
  EXPECT_EQ(one.plan, three.plan);
  EXPECT_EQ(one.robust.efficiency, three.robust.efficiency);
  EXPECT_EQ(one.bound, three.bound);
}

TEST(RobustAims, TextsAreReadAsWrittenAndOthersAreNot) {
  for (const char* text : {"mean", "worst", "tail 0.1", "tail 0.25"})
    EXPECT_EQ(robust_aim_text(robust_aim_of(text).value()), text);
  for (const char* text : {"", "median", "tail 0", "tail 1", "tail0.1", "tail x", "tail 0.1 of", "tail "})
    EXPECT_FALSE(robust_aim_of(text)) << text;
}

TEST(RobustAims, SupportingWeightsBoundTheAimFromAbove) {
  const std::vector<double> weights(scenarios, 1.0);
  const BlockArray numbers = random_blocks(40, 1, scenarios, 3);
  for (const char* text : {"mean", "worst", "tail 0.4"}) {
    const RobustAim aim = *robust_aim_of(text);
    std::vector<double> at(numbers.row(0, 0), numbers.row(0, 0) + scenarios);
    Combination combination(aim, weights, scenarios);
    const std::vector<double> lambda = combination.supporting(at);
    EXPECT_NEAR(std::accumulate(lambda.begin(), lambda.end(), 0.0), 1.0, 1e-12);
    for (std::size_t i = 0; i < numbers.count(); ++i) {
      const std::vector<double> x(numbers.row(i, 0), numbers.row(i, 0) + scenarios);
      const double linear = std::inner_product(x.begin(), x.end(), lambda.begin(), 0.0);
      EXPECT_LE(by_words(aim, x), linear + 1e-12);
      EXPECT_NEAR(combination.of(x), by_words(aim, x), 1e-12);
    }
  }
}

class DrawnRobotsOfProblems : public testing::Test {
 protected:
  TemporaryFolder folder_;
  Problem arm(const std::string& more = "", const std::string& tolerance = "0.05") {
    folder_.write("arm.urdf", planar_arm_urdf);
    folder_.write("problem.yaml",
                  "posewright: 1\nrobot: {urdf: arm.urdf}\nmeasurement: {type: points, targets: {T1: [0.1, 0.05, 0]}, "
                  "components: [x, y], device: {type: isotropic, noise: 1 mm}}\nvariants: {all: {parameters: "
                  "[q1.offset, q2.offset, q2.x], tolerance: {'*': " +
                      tolerance + "}}}\ndesign: {poses: 4, candidates: 60, restarts: 2" + more + "}\n");
    return read_problem(folder_ / "problem.yaml");
  }
};

/// From the definition, for a robot whose true values are these: the block of a pose.
Eigen::Matrix<double, 2, 3> planar_block(const std::vector<double>& q, const Eigen::Vector3d& error) {
  const double a = q[0] + error[0], b = a + q[1] + error[1];
  const auto turn = [](double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); };
  const Eigen::Vector2d elbow(1 + error[2], 0), target(0.9, 0.05);
  Eigen::Matrix2d quarter;
  quarter << 0, -1, 1, 0;
  Eigen::Matrix<double, 2, 3> J;
  J << quarter * (turn(a) * elbow + turn(b) * target), quarter * turn(b) * target, turn(a) * Eigen::Vector2d(1, 0);
  return J / 1e-3;
}

TEST_F(DrawnRobotsOfProblems, BlocksOfADrawnArmAreThoseOfItsOwnGeometry) {
  const Problem problem = arm();
  const Study study = make_study(resolve(problem, {.seed = 7, .threads = 1}, Monitor()), Monitor());
  const DrawnRobots robots(study, study.configurations, Monitor());
  double squares = 0;
  for (int k = 0; k < 50; ++k) {
    const std::vector<double> correction = robots.correction(k);
    Eigen::Vector3d error;
    for (int j = 0; j < 3; ++j) error[j] = correction[std::size_t(study.first().columns.selected[std::size_t(j)])];
    squares += error.squaredNorm() / (3 * 0.05 * 0.05);
    if (k > 3) continue;
    const BlockArray blocks = robots.blocks(k, study.configurations);
    for (std::size_t i = 0; i < 5; ++i) {
      const auto q = study.configurations[i];
      const Eigen::MatrixXd J = planar_block({q.begin(), q.end()}, error);
      EXPECT_LT((blocks.block(i).transpose() * blocks.block(i) - J.transpose() * J).norm(), 1e-6 * J.squaredNorm());
    }
  }
  // 150 squares of standard normal numbers: mean 1 ± 0.12.
  EXPECT_NEAR(squares / 50, 1.0, 0.5);
}

TEST_F(DrawnRobotsOfProblems, FiguresOfAPlanAreThoseOfItsWrittenPosesByGeometry) {
  const Problem problem = arm(", robust: {draws: 12, measure: tail 0.25}");
  const Plan plan = plan_problem(problem, {}, Monitor());
  ASSERT_TRUE(plan.robust);
  const RobustPlan& robust = *plan.robust;
  ASSERT_EQ(robust.efficiency.size(), 12U);
  EXPECT_GE(robust.value, robust.nominal_value - 1e-12);
  EXPECT_LE(robust.value, robust.bound + 1e-9);
  const Study study = make_study(resolve(problem, {}, Monitor()), Monitor());
  const DrawnRobots robots(study, study.configurations, Monitor());
  std::vector<double> logs;
  for (int k = 0; k < 12; ++k) {
    const std::vector<double> correction = robots.correction(k);
    Eigen::Vector3d error;
    for (int j = 0; j < 3; ++j) error[j] = correction[std::size_t(study.first().columns.selected[std::size_t(j)])];
    Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
    for (const PlannedPose& pose : plan.poses) {
      const Eigen::MatrixXd J = planar_block({pose.configuration[0].value, pose.configuration[1].value}, error);
      M += J.transpose() * J;
    }
    const double efficiency = std::exp((std::log(M.determinant()) - robust.references[std::size_t(k)]) / 3);
    EXPECT_NEAR(robust.efficiency[std::size_t(k)], efficiency, 1e-9);
    logs.push_back(std::log(efficiency));
  }
  std::sort(logs.begin(), logs.end());
  EXPECT_NEAR(robust.value, std::exp((logs[0] + logs[1] + logs[2]) / 3), 1e-9);
  const auto json = parse_json(plan_json(plan));
  EXPECT_EQ(json["robust"]["draws"], 12);
  EXPECT_EQ(json["robust"]["measure"], "tail 0.25");
  EXPECT_THAT(plan_summary(plan), HasSubstr("On 12 robots drawn from the tolerances"));
}

TEST_F(DrawnRobotsOfProblems, SmallTolerancesAreNotWorthAPlanOfTheirOwn) {
  Plan plan = plan_problem(arm(", robust: {draws: 10}", "1e-5"), {}, Monitor());
  ASSERT_TRUE(plan.robust);
  EXPECT_FALSE(plan.robust->worth_it());
  EXPECT_THAT(plan_summary(plan), HasSubstr("is not worthwhile, it gains 0.00 %"));
  // What no plan exceeds is rounded up.
  plan.robust->bound = 0.95128;
  EXPECT_THAT(plan_summary(plan), HasSubstr("No plan of these candidates has more than 95.2 %."));
}

TEST_F(DrawnRobotsOfProblems, ALegThatIsMovedByItsActuatorsStandsWhereTheDrawnRobotSettles) {
  const Problem problem = example("telescope/problem.yaml");
  DesignEdits options = DesignEdits().edit("candidates", 30);
  options.seed = 1;
  const Problem edited = options.of(problem);
  const Study study = make_study(resolve(edited, options, Monitor()), Monitor());
  const DrawnRobots robots(study, study.configurations, Monitor());
  const std::vector<double> correction = robots.correction(0);
  // A second robot whose nominal values are those of the drawn one; its platform is found from the actuators.
  Variant other = place_variant({problem, *study.first().spec}, study.cell);
  for (std::size_t i = 0; i < correction.size(); ++i)
    if (correction[i] != 0) other.model->set_nominal(int(i), other.model->parameters()[i].nominal + correction[i]);
  const BlockArray drawn = robots.blocks(0, study.configurations);
  std::vector<double> actuators(other.model->actuators().size()), q(std::size_t(study.configurations.dimension));
  Linearisation scratch;
  BlockArray own(1, drawn.rows(), drawn.columns());
  for (std::size_t i = 0; i < 5; ++i) {
    const auto nominal = study.configurations[i];
    ASSERT_TRUE(study.first().model->actuator_values(nominal, actuators));
    ASSERT_TRUE(other.model->configuration_at(actuators, nominal, q));
    ASSERT_TRUE(
        whitened_block(*other.model, q, {}, study.first().columns.selected, scratch, own.row(0, 0), own.stride()));
    const Eigen::MatrixXd mine = own.block(0).transpose() * own.block(0);
    EXPECT_LT((drawn.block(i).transpose() * drawn.block(i) - mine).norm(), 1e-6 * mine.norm());
  }
}

TEST_F(DrawnRobotsOfProblems, WhatDoesNotGoTogetherIsRefusedWithItsLine) {
  const auto refused = [&](const std::string& more, const std::string& text) {
    EXPECT_THAT(message_of<InputError>([&] { plan_problem(arm(more), {}, Monitor()); }),
                testing::AllOf(HasSubstr(text), HasSubstr("problem.yaml:5")));
  };
  refused(", robust: {draws: 1}", "draws");
  refused(", robust: {measure: median}", "is no measure");
  refused(", robust: {robots: 5}", "robots");
  refused(", robust: {}, criterion: o3", "not for criterion 'o3'");
  refused(", robust: {}, criterion: compound", "is for one variant");
  refused(", robust: {}, reserve: yes", "cannot be combined with reserve");
}

TEST_F(DrawnRobotsOfProblems, ValidationPosesAreThoseOfTheNominalRobot) {
  const Problem problem = arm(", robust: {draws: 5}");
  const Plan plan = plan_problem(problem, {}, Monitor());
  const Plan validation = plan_validation(problem, {}, plan, 2, Monitor());
  EXPECT_FALSE(validation.robust);
  EXPECT_EQ(std::count_if(validation.poses.begin(), validation.poses.end(), [](const auto& p) { return !p.measured; }),
            2);
}

TEST_F(DrawnRobotsOfProblems, AStopKeepsThePlanOfTheNominalRobot) {
  const Problem problem = arm(", robust: {draws: 2000}");
  std::atomic<bool> stop = false;
  Monitor monitor;
  monitor.interrupted = &stop;
  monitor.on_progress = [&](const Progress& progress) {
    if (progress.stage == "drawn robots") stop = true;
  };
  const Plan plan = plan_problem(problem, {}, monitor);
  EXPECT_TRUE(plan.interrupted);
  ASSERT_TRUE(plan.robust);
  EXPECT_TRUE(plan.robust->stopped);
  EXPECT_EQ(plan.poses.size(), 4U);
  EXPECT_THAT(plan_summary(plan), HasSubstr("stopped before all were evaluated"));
}

}  // namespace
}  // namespace posewright
