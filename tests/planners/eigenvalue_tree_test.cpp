// Branch and bound for o3 against enumeration: what single rows must be like, boxes, and whole trees.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "planners/design_tree.hpp"
#include "planners/planner_registry.hpp"
#include "planners/row_inertia.hpp"
#include "posewright/criterion/registry.hpp"
#include "tests/kit/random_blocks.hpp"
#include "tests/planners/best_in_box.hpp"

namespace posewright {
namespace {

CriterionData graded_data(int columns, int nuisance) {
  CriterionData data{Eigen::MatrixXd::Identity(columns, columns), Eigen::VectorXd::Ones(columns), nuisance};
  for (int j = 0; j < columns; ++j) data.scale[j] = 0.5 + 0.3 * j;
  return data;
}

double least_eigenvalue_of(const Eigen::MatrixXd& M) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// All multisets of `left` of f rows, each at most room[i] times.
void for_each_choice(const Eigen::VectorXd& room, int left, const std::function<void(const std::vector<int>&)>& visit) {
  std::vector<int> chosen;
  const std::function<void(int)> next = [&](int first) {
    if (int(chosen.size()) == left) return visit(chosen);
    for (int i = first; i < int(room.size()); ++i) {
      if (double(std::count(chosen.begin(), chosen.end(), i)) >= room[i]) continue;
      chosen.push_back(i);
      next(i);
      chosen.pop_back();
    }
  };
  next(0);
}

TEST(RowInertia, RulesOutNoRowOfAnyChoiceThatReachesTheThresholdAndItsLimitsHoldForAllOfThem) {
  int ruled_out = 0, nothing = 0, exclusive = 0, reached = 0, slacks[4] = {};
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    Random random(seed, 8);
    const int m = 3 + int(seed % 3), f = 8, left = 2 + int(seed / 3 % 4), known_rows = m + int(seed % 4) - left + 1;
    const BlockArray blocks = random_blocks(std::size_t(f + m + 3), 1, m, 4000 + seed);
    Eigen::MatrixXd known = Eigen::MatrixXd::Zero(m, m);
    for (int k = 0; k < std::max(0, known_rows); ++k) {
      const auto row = blocks.block(std::size_t(f + k));
      known += row.transpose() * row;
    }
    RowInertia::RowMatrix rows(f, m);
    for (int i = 0; i < f; ++i) rows.row(i) = blocks.block(std::size_t(i));
    Eigen::VectorXd room = Eigen::VectorXd::Ones(f), weight(f);
    for (int i = 0; i < f; ++i) {
      if (seed % 4 == 0 && random.uniform() < 0.5) room[i] = 2;
      weight[i] = random.uniform();
    }
    std::vector<double> values;
    const auto value_of = [&](const std::vector<int>& chosen) {
      Eigen::MatrixXd M = known;
      for (const int i : chosen) M += rows.row(i).transpose() * rows.row(i);
      return least_eigenvalue_of(M);
    };
    for_each_choice(room, left, [&](const std::vector<int>& chosen) { values.push_back(value_of(chosen)); });
    std::sort(values.begin(), values.end());
    // Reached by a few choices, by one as it is, or by none.
    const double threshold = seed % 3 == 0   ? values[values.size() * 9 / 10]
                             : seed % 3 == 1 ? values.back()
                                             : values.back() * (1 + 1e-6);
    if (threshold <= 0) continue;
    RowInertia inertia;
    const bool any = inertia.look(known, rows, room, left, threshold);
    if (any) ++slacks[std::clamp(inertia.slack(), 0, 3)];
    nothing += any ? 0 : 1;
    std::vector<int> few;
    if (any && inertia.slack() > 0 && inertia.slack() < left) few = inertia.exclusive(weight, room);
    exclusive += int(few.size()) > inertia.slack() ? 1 : 0;
    for (int i = 0; i < f; ++i) ruled_out += any && !inertia.possible(i) ? 1 : 0;
    for_each_choice(room, left, [&](const std::vector<int>& chosen) {
      if (value_of(chosen) < threshold) return;
      ++reached;
      ASSERT_TRUE(any) << seed;
      double shortfall = 0.0;
      int of_few = 0;
      for (const int i : chosen) {
        EXPECT_TRUE(inertia.possible(i)) << seed;
        shortfall += inertia.shortfall()[i];
        of_few += int(std::count(few.begin(), few.end(), i));
      }
      if (inertia.slack() == 0) {
        EXPECT_EQ(std::adjacent_find(chosen.begin(), chosen.end()), chosen.end()) << seed;
      }
      EXPECT_LE(shortfall, inertia.slack() + 1e-9) << seed;
      if (!few.empty()) {
        EXPECT_LE(of_few, inertia.slack()) << seed;
      }
    });
  }
  EXPECT_GT(ruled_out, 300);
  EXPECT_GT(nothing, 30);
  EXPECT_GT(exclusive, 20);
  EXPECT_GT(reached, 1000);
  for (const int count : slacks) EXPECT_GT(count, 10);
}

TEST(EigenvalueTree, NoDesignOfABoxIsBetterThanItsBoundAndTighteningLosesNoneThatIs) {
  int tightened = 0, ruled_out = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed, 4);
    const int columns = 3 + int(seed % 4), rows = seed % 6 == 5 ? 2 : 1, repeats = seed % 3 == 0 ? 2 : 1,
              nuisance = seed % 5 == 4 ? 1 : 0;
    const BlockArray blocks = random_blocks(11, rows, columns, 1700 + seed);
    const auto criterion = make_criterion("o3", graded_data(columns, nuisance));
    const Eigen::MatrixXd prior = 0.3 * blocks.block(0).transpose() * blocks.block(0);
    DesignTask task{{&blocks, nuisance, repeats, seed % 7 == 0 ? &prior : nullptr},
                    criterion.get(),
                    std::max(4, columns + int(seed % 2)),
                    nullptr};
    ChoiceBox box{std::vector<std::uint16_t>(11, 0), std::vector<std::uint16_t>(11, std::uint16_t(repeats))};
    for (int k = 0; k < int(seed % 5); ++k) {
      const auto c = std::size_t(random.index(11));
      if (random.uniform() < 0.6) box.least[c] = box.most[c] = std::uint16_t(std::max<int>(1, box.most[c]));
      else box.most[c] = box.least[c];
    }
    std::vector<int> members;
    const double best = best_in_box(task, box, 0, members);
    const double known = best + (random.uniform() < 0.7 ? -1 : 1) * (seed % 2 == 0 ? 0.3 : 0.01) * random.uniform();
    NodeRelaxation relaxation(task);
    RelaxedBox relaxed;
    relaxed.numbers.assign(11, task.poses / 11.0);
    if (!relaxation.solve(box, relaxed, std::isfinite(best) ? known : -100.0)) {
      EXPECT_FALSE(best > known + 1e-9) << seed;
      ++ruled_out;
      continue;
    }
    if (relaxed.branch >= 0) {
      EXPECT_GE(relaxed.bound, best - 1e-9) << seed;
      EXPECT_LT(box.least[std::size_t(relaxed.branch)], box.most[std::size_t(relaxed.branch)]) << seed;
    }
    if (best <= known) continue;
    EXPECT_NEAR(best_in_box(task, box, 0, members), best, 1e-12) << seed;
    if (box.most != std::vector<std::uint16_t>(11, std::uint16_t(repeats))) ++tightened;
  }
  EXPECT_GT(tightened, 50);
  EXPECT_GT(ruled_out, 50);
}

TEST(EigenvalueTree, FindsTheOptimumFromTheWorstDesignOnAnyNumberOfThreads) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const int columns = 4 + int(seed % 3), repeats = seed % 4 == 3 ? 2 : 1;
    const BlockArray blocks = random_blocks(seed % 4 == 3 ? 11 : 16, 1, columns, 2900 + seed);
    const auto criterion = make_criterion("o3", graded_data(columns, 0));
    DesignTask task{{&blocks, 0, repeats}, criterion.get(), columns + int(seed % 3), nullptr};
    ChoiceBox whole{std::vector<std::uint16_t>(blocks.count(), 0),
                    std::vector<std::uint16_t>(blocks.count(), std::uint16_t(repeats))};
    std::vector<int> members;
    const double optimum = best_in_box(task, whole, 0, members);
    expect_found_from_the_worst(task, optimum, seed);
  }
}

TEST(EigenvalueTree, ASearchBesideItIsAskedForMoreStartsAsItGrowsAndItsDesignCounts) {
  // So many nearly equal candidates that the tree is no small one.
  const BlockArray blocks = random_blocks(100, 1, 9, 6100);
  const auto criterion = make_criterion("o3", graded_data(9, 0));
  DesignTask task{{&blocks, 0, 1}, criterion.get(), 14, nullptr};
  const Design proved = find_planner("branch_and_bound")->plan(task, {}, Monitor{});
  ASSERT_TRUE(proved.optimal);
  Design design = proved;
  design.value = -50.0;
  int calls = 0, before = 0;
  DesignTree tree(task, 2, Monitor{}, design);
  tree.search_beside([&](int starts, int call) {
    EXPECT_EQ(call, ++calls);
    EXPECT_GT(starts, before);
    before = starts;
    return proved;
  });
  EXPECT_TRUE(tree.run());
  EXPECT_GE(calls, 1);
  EXPECT_EQ(design.members, proved.members);
  EXPECT_NEAR(design.value, proved.value, 1e-12);
}

TEST(EigenvalueTree, AGapEndsTheProofWhereNoDesignIsBetterByMore) {
  int early = 0;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const int columns = 4 + int(seed % 2);
    const BlockArray blocks = random_blocks(15, 1, columns, 5100 + seed);
    const auto criterion = make_criterion(seed % 3 == 2 ? "o1" : "o3", graded_data(columns, 0));
    DesignTask task{{&blocks, 0, 1}, criterion.get(), columns + 2, nullptr};
    ChoiceBox whole{std::vector<std::uint16_t>(15, 0), std::vector<std::uint16_t>(15, 1)};
    std::vector<int> members;
    const double optimum = best_in_box(task, whole, 0, members);
    Design design;
    design.value = -50.0;
    EXPECT_TRUE(DesignTree(task, 2, Monitor{}, design, 0.2).run());
    // In e^{Φ/h}.
    const double allowed = criterion->function().degree() * std::log(1.2);
    EXPECT_GE(design.value, optimum - allowed) << seed;
    EXPECT_GE(*design.bound, optimum - 1e-9) << seed;
    EXPECT_LE(*design.bound, design.value + allowed + 1e-9) << seed;
    PlannerOptions options;
    options.gap = 0.2;
    const Design planned = find_planner("branch_and_bound")->plan(task, options, Monitor{});
    EXPECT_FALSE(planned.stopped);
    EXPECT_GE(*planned.bound, optimum - 1e-9) << seed;
    EXPECT_LE(*planned.bound, planned.value + allowed + 1e-9) << seed;
    early += planned.optimal ? 0 : 1;
  }
  EXPECT_EQ(early, 24);  // nobody is told of a proof that was not made
}

}  // namespace
}  // namespace posewright
