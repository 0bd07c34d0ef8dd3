// What a search by restarts promises to whoever asks for more of them.

#include "planners/restarts.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "planners/planner_registry.hpp"
#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/registry.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

CriterionData unit_data(int columns) {
  return {Eigen::MatrixXd::Identity(columns, columns), Eigen::VectorXd::Ones(columns), 0};
}

TEST(Restarts, ARestartHasTheSameKicksHoweverManyThereAre) {
  const BlockArray blocks = random_blocks(2000, 1, 30, 4);
  const auto criterion = make_criterion("o1", unit_data(30));
  const DesignTask task{{&blocks, 0, 1}, criterion.get(), 60};
  PlannerOptions usual, many, one;
  many.restarts = 5000;
  one.restarts = 1;
  const int kicks = affordable_kicks(task, usual);
  EXPECT_GT(kicks, 0);
  EXPECT_EQ(affordable_kicks(task, many), kicks);
  EXPECT_EQ(affordable_kicks(task, one), kicks);
}

TEST(Restarts, MoreOfThemAreNeverWorse) {
  const BlockArray blocks = random_blocks(300, 1, 8, 5);
  const auto criterion = make_criterion("o1", unit_data(8));
  const DesignTask task{{&blocks, 0, 1}, criterion.get(), 12};
  double before = -std::numeric_limits<double>::infinity();
  for (const int restarts : {1, 2, 5, 20, 60}) {
    PlannerOptions options;
    options.restarts = restarts;
    const double value = find_planner("exchange")->plan(task, options, Monitor{}).value;
    EXPECT_GE(value, before - 1e-12) << restarts;
    before = value;
  }
}

TEST(Restarts, GreedyStartsOnceWhereAStartTakesLongUnlessMoreAreStated) {
  const auto criterion = make_criterion("o1", unit_data(6));
  const auto restarts = [&](std::size_t candidates, bool stated) {
    const BlockArray blocks = random_blocks(candidates, 2, 6, 6);
    PlannerOptions options;
    options.restarts_stated = stated;
    return find_planner("greedy")->plan({{&blocks, 0, 1}, criterion.get(), 900}, options, Monitor{}).restarts;
  };
  EXPECT_EQ(restarts(2000, false), 10);
  EXPECT_EQ(restarts(60000, false), 1);
  EXPECT_EQ(restarts(2000, true), 10);
}

class LogDetWithoutBound : public LogDetFunction {
 public:
  using LogDetFunction::LogDetFunction;
  double degree() const override { return 0; }
};

TEST(Restarts, WithoutABoundCandidatesBeyondTheFirstSampleAreTakenUp) {
  const int columns = 8, poses = 12;
  const BlockArray blocks = random_blocks(6000, 1, columns, 7);
  std::vector<int> sample;
  for (int i = 0; i < 400; ++i) sample.push_back(i * 6000 / 400);
  const BlockArray some = blocks.subset(sample);
  const FunctionCriterion without("without", std::make_shared<LogDetWithoutBound>(0, columns));
  const auto criterion = make_criterion("o1", unit_data(columns));
  const auto value = [&](const BlockArray& among, const Criterion& by) {
    return find_planner("exchange")->plan({{&among, 0, 1}, &by, poses}, PlannerOptions{}, Monitor{}).value;
  };
  EXPECT_GT(value(blocks, without), value(some, *criterion) + 0.5);
  EXPECT_NEAR(value(blocks, without), value(blocks, *criterion), 0.3);
}

}  // namespace
}  // namespace posewright
