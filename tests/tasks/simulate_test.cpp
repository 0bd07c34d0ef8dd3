// Virtual experiments through the whole pipeline.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "posewright/problem/read_problem.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/compare_problem.hpp"
#include "posewright/tasks/simulate_problem.hpp"
#include "posewright/workspace/candidates.hpp"
#include "src/tasks/simulation_verdict.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/pose_lists.hpp"

namespace posewright {
namespace {

using testing::Contains;
using testing::HasSubstr;

SimulateOptions quick(const std::string& variant, int draws) {
  SimulateOptions options;
  options.variant = variant;
  options.validation = 10;
  options.experiment.draws = draws;
  return options;
}

TEST(Simulate, ArmIsAsPredictedAtThePlacesToo) {
  const Problem problem = example("kr270/problem.yaml");
  const Simulation s =
      simulate_problem(problem, given_poses(problem, list_of(problem, 18)), quick("geometric", 200), Monitor{});
  EXPECT_EQ(s.summary.fitted, 200);
  EXPECT_EQ(s.readings, 18 * 9);
  ASSERT_TRUE(s.accuracy);
  EXPECT_EQ(s.accuracy->places, 10);
  // Every draw's error is kept: their mean square is the one that is stated, and none is larger than the largest place.
  ASSERT_EQ(s.summary.distances.size(), 200U);
  double squares = 0;
  for (const double distance : s.summary.distances) squares += distance * distance;
  EXPECT_NEAR(std::sqrt(squares / 200), s.accuracy->observed, 1e-12);
  EXPECT_TRUE(std::is_sorted(s.summary.distances.begin(), s.summary.distances.end()));
  EXPECT_LE(s.summary.distances.back(), s.accuracy->largest);
  EXPECT_FALSE(s.accuracy->test_poses);
  EXPECT_NEAR(s.accuracy->observed / s.accuracy->predicted, 1, 0.1);
  EXPECT_LT(s.curvature.largest, curvature_limit);
  EXPECT_THAT(s.first_readings, HasSubstr("P1.x"));
}

TEST(Simulate, OtherNominalValuesBiasTheEstimatesAsComparingSays) {
  const Problem problem = example("telescope/problem.yaml");
  const auto list = list_of(problem, 20);
  SimulateOptions options = quick("linear", 60);
  options.truth = "matrix";
  options.truth_nominal = true;
  options.experiment.exact = true;
  const Simulation s = simulate_problem(problem, given_poses(problem, list), options, Monitor{});
  EXPECT_FALSE(s.confirmed);
  EXPECT_THAT(s.verdict, Contains(HasSubstr("readings come from matrix")));
  EXPECT_THAT(s.verdict, Contains(HasSubstr("power")));
  Problem few = problem;
  few.design.candidates.value = 200;
  CompareOptions compare;
  compare.variants = {"linear", "matrix"};
  compare.plans.push_back({"list", given_poses(problem, list)});
  const Comparison c = compare_problem(few, compare, Monitor{});
  const auto alias =
      std::find_if(c.aliases.begin(), c.aliases.end(), [](const auto& a) { return a.fitted == "linear"; });
  ASSERT_NE(alias, c.aliases.end());
  ASSERT_EQ(alias->parameters.size(), s.parameters.size());
  for (std::size_t j = 0; j < s.parameters.size(); ++j) {
    const ParameterErrors& e = *s.parameters[j].errors;
    EXPECT_NEAR(e.bias, alias->parameters[j].shift, 5 * e.bias_error + 0.1 * std::abs(alias->parameters[j].shift))
        << s.parameters[j].label.name;
  }
}

TEST(Simulate, SaysWhereThePredictionCannotHold) {
  const Problem problem = example("telescope/problem.yaml");
  const Simulation s =
      simulate_problem(problem, given_poses(problem, list_of(problem, 20)), quick("rigid", 30), Monitor{});
  EXPECT_FALSE(s.confirmed);
  EXPECT_GT(s.curvature.largest, curvature_limit);
  EXPECT_THAT(s.verdict, Contains(HasSubstr("nonlinear within one σ")));
}

TEST(Simulate, VariantsOfOtherCataloguesAreComparedByReadingsAlone) {
  const Problem problem = example("kr270/problem.yaml");
  SimulateOptions options = quick("geometric", 20);
  options.truth = "denavit_hartenberg";
  options.candidates = 200;
  const Simulation s = simulate_problem(problem, given_poses(problem, list_of(problem, 18)), options, Monitor{});
  EXPECT_FALSE(s.parameters.front().errors);
  EXPECT_THAT(s.verdict, Contains(HasSubstr("use different kinds of parameters")));
  ASSERT_TRUE(s.accuracy);
  EXPECT_GT(s.accuracy->observed, 0);
  options.truth_nominal = true;
  EXPECT_THROW(simulate_problem(problem, given_poses(problem, list_of(problem, 18)), options, Monitor{}), CannotDo);
}

TEST(Simulate, TakesTheFilesCandidatesForAutomaticParameters) {
  Problem problem = example("kr270/problem.yaml");
  problem.design.candidates.value = 2;
  SimulateOptions options = quick("automatic", 2);
  const auto parameters = [&] {
    return simulate_problem(problem, given_poses(problem, list_of(problem, 18)), options, Monitor{}).parameters.size();
  };
  EXPECT_LT(parameters(), 18U) << "two poses cannot identify as many";
  options.candidates = 200;
  EXPECT_EQ(parameters(), 33U);
}

TEST(Simulate, RefusesWhatDoesNotDetermineTheParameters) {
  const Problem problem = example("kr270/problem.yaml");
  EXPECT_THROW(simulate_problem(problem, given_poses(problem, list_of(problem, 3)), quick("geometric", 5), Monitor{}),
               CannotDo);
  EXPECT_THROW(simulate_problem(problem, given_poses(problem, list_of(problem, 18)), quick("none", 5), Monitor{}),
               InputError);
}

TEST(SimulationVerdict, TestsTogetherRefuseWronglyAtTheirLevelAndNotOftener) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform;
  constexpr int rounds = 20'000, tests = 30;
  int together = 0, alone = 0, found = 0;
  for (int i = 0; i < rounds; ++i) {
    std::vector<double> chances(tests);
    for (double& chance : chances) chance = uniform(generator);
    const auto any = [](const std::vector<bool>& refused) {
      return std::any_of(refused.begin(), refused.end(), [](bool r) { return r; });
    };
    together += any(refused_together(chances, 0.05)) ? 1 : 0;
    alone += *std::min_element(chances.begin(), chances.end()) <= 0.05 ? 1 : 0;
    chances[3] = 1e-3 * uniform(generator);  // a difference that is there
    found += refused_together(chances, 0.05)[3] ? 1 : 0;
  }
  // 1 − (1 − 0.05/30)³⁰ = 4.88 %, and 1 − 0.95³⁰ = 78.5 % of the tests one by one; error 0.15 %.
  EXPECT_NEAR(double(together) / rounds, 0.0488, 0.006);
  EXPECT_NEAR(double(alone) / rounds, 0.785, 0.012);
  EXPECT_EQ(found, rounds);
}

TEST(SimulationVerdict, ARightModelIsHardlyEverRefusedAndAWrongOneFound) {
  const Problem problem = example("kr270/problem.yaml");
  const PoseList poses = given_poses(problem, list_of(problem, 18));
  SimulateOptions options = quick("geometric", 30);
  options.validation = 1;
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    options.experiment.seed = seed;
    refused += simulate_problem(problem, poses, options, Monitor{}).confirmed ? 0 : 1;
  }
  // At most 1 % each: 3 or more of 30 have a chance of 0.3 %. One by one at three errors a quarter were refused.
  EXPECT_LE(refused, 2);
  options.truth_noise.repeatability = 30e-6;
  const Simulation wrong = simulate_problem(problem, poses, options, Monitor{});
  EXPECT_FALSE(wrong.confirmed);
  EXPECT_THAT(wrong.verdict, Contains(HasSubstr("other noise than the problem states")));
}

}  // namespace
}  // namespace posewright
