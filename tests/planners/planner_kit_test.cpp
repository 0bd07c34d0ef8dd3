// Conformance kit: what every planner in the registry must do, under every criterion.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "planners/registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

struct Case {
  std::string planner, criterion;
  int rows;
  bool repeats;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.planner << ", " << c.criterion << ", r = " << c.rows << (c.repeats ? ", repeats allowed" : ", no repeats");
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const PlannerEntry& planner : planner_registry())
    for (const CriterionEntry& criterion : criterion_registry())
      for (const int rows : {1, 3})
        for (const bool repeats : {false, true}) cases.push_back({planner.name, criterion.name, rows, repeats});
  return cases;
}

/// Unequal units, three places where accuracy matters.
CriterionData kit_data(int columns, int nuisance) {
  CriterionData data{Eigen::MatrixXd::Identity(columns, columns), Eigen::VectorXd::LinSpaced(columns, 0.5, 2.0),
                     nuisance};
  const BlockArray points = random_blocks(3, 2, columns, 99);
  for (std::size_t t = 0; t < 3; ++t) {
    Eigen::MatrixXd A = points.block(t);
    A.leftCols(nuisance).setZero();
    data.test_points.push_back({A, 1.0 + double(t)});
  }
  return data;
}

double value_of(const Criterion& criterion, const CandidateView& view, const std::vector<int>& members) {
  return criterion.start(view, members)->value();
}

/// Best value over all sets, by enumeration.
double optimum(const Criterion& criterion, const CandidateView& view, int poses, bool repeats) {
  const int n = int(view.blocks->count());
  std::vector<int> members(std::size_t(poses), 0);
  double best = -std::numeric_limits<double>::infinity();
  const auto next = [&](auto&& self, int position, int first) -> void {
    if (position == poses) {
      best = std::max(best, value_of(criterion, view, members));
      return;
    }
    for (int i = first; i < n; ++i) {
      members[std::size_t(position)] = i;
      self(self, position + 1, repeats ? i : i + 1);
    }
  };
  next(next, 0, 0);
  return best;
}

class PlannerKit : public testing::TestWithParam<Case> {
 protected:
  Design plan(const BlockArray& blocks, int poses, std::uint64_t seed, int threads, int nuisance = 0,
              int restarts = 8) const {
    const auto criterion = make_criterion(GetParam().criterion, kit_data(blocks.columns(), nuisance));
    ApproximateDesignOptions bound;
    bound.cap = GetParam().repeats ? 1.0 : 1.0 / poses;
    ApproximateDesign approximate = solve_approximate_design(blocks, nuisance, bound, Monitor{});
    // What the weights say of candidates holds for determinants only.
    if (find_criterion(GetParam().criterion)->bound != BoundKind::log_det) approximate.sensitivity.clear();
    DesignTask task{{&blocks, nuisance, GetParam().repeats ? poses : 1}, criterion.get(), poses, &approximate};
    PlannerOptions options;
    options.restarts = restarts;
    options.seed = seed;
    options.threads = threads;
    // Criteria without a swap formula cost a factorisation for every candidate they look at.
    if (find_criterion(GetParam().criterion)->bound == BoundKind::none) options.kicks = 5;
    return make_planner(GetParam().planner)->plan(task, options, Monitor{});
  }
};

TEST_P(PlannerKit, FindsTheOptimumOfTinyProblems) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    BlockArray blocks = random_blocks(10, GetParam().rows, 4, 40 + seed);
    whiten(blocks);
    const int poses = 5;
    const auto criterion = make_criterion(GetParam().criterion, kit_data(blocks.columns(), 0));
    const CandidateView view{&blocks, 0, GetParam().repeats ? poses : 1};
    const double best = optimum(*criterion, view, poses, GetParam().repeats);
    const Design design = plan(blocks, poses, seed, 1);
    EXPECT_LE(design.value, best + 1e-9);
    if (design.value > best - 1e-9) ++found;
  }
  EXPECT_GE(found, 11) << "of 12 tiny problems";
}

TEST_P(PlannerKit, ReturnsExactlyNWithinTheRepeatPolicyAndBeatsRandomSets) {
  BlockArray blocks = random_blocks(500, GetParam().rows, 8, 77);
  whiten(blocks);
  const Design design = plan(blocks, 20, 1, 2);
  ASSERT_EQ(design.members.size(), 20U);
  EXPECT_TRUE(std::is_sorted(design.members.begin(), design.members.end()));
  if (!GetParam().repeats) {
    EXPECT_EQ(std::adjacent_find(design.members.begin(), design.members.end()), design.members.end());
  }
  const auto criterion = make_criterion(GetParam().criterion, kit_data(blocks.columns(), 0));
  const CandidateView view{&blocks, 0, GetParam().repeats ? 20 : 1};
  EXPECT_NEAR(value_of(*criterion, view, design.members), design.value, 1e-9);
  Random random(6, 0);
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<int> members;
    while (members.size() < 20)
      if (const int i = random.index(500); std::find(members.begin(), members.end(), i) == members.end())
        members.push_back(i);
    EXPECT_LT(value_of(*criterion, view, members), design.value);
  }
}

TEST_P(PlannerKit, SameSeedSamePlanOnAnyNumberOfThreads) {
  BlockArray blocks = random_blocks(300, GetParam().rows, 9, 5);
  whiten(blocks);
  const Design one = plan(blocks, 15, 3, 1);
  for (const int threads : {2, 4}) {
    const Design other = plan(blocks, 15, 3, threads);
    EXPECT_EQ(other.members, one.members);
    EXPECT_EQ(other.value, one.value);
  }
}

TEST_P(PlannerKit, NuisanceColumnsAreEliminated) {
  BlockArray blocks = random_blocks(60, GetParam().rows, 6, 15);
  whiten(blocks);
  const Design design = plan(blocks, 12, 0, 1, 2);
  EXPECT_EQ(design.members.size(), 12U);
  EXPECT_TRUE(std::isfinite(design.value));
}

TEST_P(PlannerKit, AsManyPosesAsCandidatesIsNoSpecialCase) {
  BlockArray blocks = random_blocks(9, GetParam().rows, 4, 15);
  whiten(blocks);
  const Design design = plan(blocks, 9, 0, 1);
  ASSERT_EQ(design.members.size(), 9U);
  if (!GetParam().repeats) {
    EXPECT_EQ(design.members, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  }
}

TEST_P(PlannerKit, ContradictoryTasksAreRefused) {
  const BlockArray blocks = random_blocks(9, GetParam().rows, 4, 15);
  const auto criterion = make_criterion(GetParam().criterion, kit_data(blocks.columns(), 0));
  const auto planner = make_planner(GetParam().planner);
  EXPECT_THROW(planner->plan({{&blocks, 0, 1}, criterion.get(), 10, nullptr}, {}, Monitor{}), std::invalid_argument);
  EXPECT_THROW(planner->plan({{&blocks, 0, 1}, criterion.get(), 0, nullptr}, {}, Monitor{}), std::invalid_argument);
  EXPECT_THROW(planner->plan({{nullptr, 0, 1}, criterion.get(), 2, nullptr}, {}, Monitor{}), std::invalid_argument);
  EXPECT_THROW(planner->plan({{&blocks, 0, 1}, nullptr, 2, nullptr}, {}, Monitor{}), std::invalid_argument);
  const int too_few = GetParam().rows == 1 ? 3 : 1;
  EXPECT_THROW(planner->plan({{&blocks, 0, 1}, criterion.get(), too_few, nullptr}, {}, Monitor{}), CannotDo);
}

TEST_P(PlannerKit, GainsOfSingularSetsAreFiniteAndComeToAnEnd) {
  const BlockArray blocks = random_blocks(30, GetParam().rows, 12, 8);
  for (const int nuisance : {0, 4}) {
    const auto state = make_criterion(GetParam().criterion, kit_data(blocks.columns(), nuisance))
                           ->start({&blocks, nuisance, 1}, {0, 1, 2});
    int swaps = 0;
    for (bool gained = true; gained && swaps < 500;) {
      gained = false;
      for (int p = 0; p < 3; ++p) {
        const Swap swap = state->best_swap(p, 1e-9);
        EXPECT_TRUE(std::isfinite(swap.gain));
        if (swap.enter < 0) continue;
        state->apply(p, swap.enter);
        gained = true;
        ++swaps;
      }
    }
    EXPECT_LT(swaps, 500);
  }
}

TEST_P(PlannerKit, StopsWhenToldAndStillReturnsAPlan) {
  BlockArray blocks = random_blocks(500, GetParam().rows, 8, 77);
  whiten(blocks);
  const auto criterion = make_criterion(GetParam().criterion, kit_data(blocks.columns(), 0));
  std::atomic<bool> stop{true};
  Monitor monitor;
  monitor.interrupted = &stop;
  PlannerOptions options;
  options.restarts = 1000000;
  const Design design =
      make_planner(GetParam().planner)->plan({{&blocks, 0, 1}, criterion.get(), 20, nullptr}, options, monitor);
  EXPECT_EQ(design.members.size(), 20U);
  EXPECT_TRUE(design.stopped);
}

INSTANTIATE_TEST_SUITE_P(All, PlannerKit, testing::ValuesIn(all_cases()), [](const auto& instance) {
  return instance.param.planner + "_" + instance.param.criterion + "_r" + std::to_string(instance.param.rows) +
         (instance.param.repeats ? "_repeats" : "_once");
});

}  // namespace
}  // namespace posewright
